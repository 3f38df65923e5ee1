"""Actions between processes of one submission in lock-step: goals, feedback, results and cancellations."""

import pytest

TOOLS = """
import time
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from tf2_msgs.action import LookupTransform
def now():
    return node.get_clock().now().nanoseconds // 10**8
"""
# Takes 0.3 s for a goal, and gives feedback every 0.1 s; asleep like the tutorials' servers, or in a thread of a pool.
SERVER = """
def execute(handle):
    for step in range(3):
        if handle.is_cancel_requested:
            handle.canceled()
            return LookupTransform.Result()
        handle.publish_feedback(LookupTransform.Feedback())
        time.sleep(0.1)
    handle.succeed()
    result = LookupTransform.Result()
    result.error.error_string = f"{handle.request.target_frame} at {now()}"
    return result
def accept(goal):
    return GoalResponse.REJECT if goal.target_frame == "nowhere" else GoalResponse.ACCEPT
ActionServer(node, LookupTransform, "look", execute, goal_callback=accept,
    cancel_callback=lambda goal: CancelResponse.ACCEPT, callback_group=ReentrantCallbackGroup())
"""
SPIN = "rclpy.spin(node)"
POOL = "executor = MultiThreadedExecutor(4); executor.add_node(node); executor.spin()"
CLIENT = """
said = node.create_publisher(String, "/said", 10)
def say(text):
    said.publish(String(data=f"{text} at {now()}"))
client = ActionClient(node, LookupTransform, "look")
client.wait_for_server()
def answered(future):
    handle = future.result()
    say("accepted" if handle.accepted else "rejected")
    if handle.accepted:
        handle.get_result_async().add_done_callback(done)
        accepted(handle)
def accepted(handle):
    pass
def done(future):
    say(f"{future.result().status}: {future.result().result.error.error_string}")
def ask(frame):
    goal = LookupTransform.Goal(target_frame=frame)
    client.send_goal_async(goal, lambda feedback: say("feedback")).add_done_callback(answered)
"""


@pytest.fixture
def said(play):
    """What is said in a run of a server and a client, in step; time is simulated for everybody."""

    def call(client, server=SERVER + SPIN, ticks=8):
        run = play(ticks=ticks, server=TOOLS + server, client=TOOLS + CLIENT + client, simulated=True)
        assert run.pace.paced_ticks == 0, run.lines
        return run.heard

    return call


@pytest.mark.parametrize(
    ("spin", "ends"),
    # The clock of a node that sleeps in its only thread stands still.
    [pytest.param(SPIN, 1, id="one thread"), pytest.param(POOL, 3, id="pool", marks=pytest.mark.proof)],
)
def test_a_goal_has_feedback_and_a_result(said, spin, ends):
    heard = said(
        """
def once():
    timer.cancel()
    ask("map")
timer = node.create_timer(0.1, once)
rclpy.spin(node)
""",
        SERVER + spin,
    )
    # A server that sleeps wakes before the /clock of the tick has come (test_sleeping.py).
    assert sorted(heard[:2]) == ["accepted at 1", "feedback at 1"]
    assert heard[2:] == ["feedback at 1", "feedback at 2", f"4: map at {ends} at 3"]


@pytest.mark.proof
def test_a_goal_is_rejected(said):
    code = """
def once():
    timer.cancel()
    ask("nowhere")
timer = node.create_timer(0.1, once)
rclpy.spin(node)
"""
    assert said(code, ticks=4) == ["rejected at 1"]


def test_a_goal_is_cancelled(said):
    code = """
def accepted(handle):
    def cancel():
        later.cancel()
        handle.cancel_goal_async().add_done_callback(
            lambda future: say(f"{len(future.result().goals_canceling)} cancelled"))
    later = node.create_timer(0.1, cancel)
def once():
    timer.cancel()
    ask("map")
timer = node.create_timer(0.1, once)
rclpy.spin(node)
"""
    heard = said(code, SERVER + POOL)
    assert "1 cancelled at 2" in heard
    assert heard[-1].startswith("5: ")


def test_it_is_the_same_within_one_process(play):
    code = (
        TOOLS
        + SERVER
        + CLIENT.replace("client.wait_for_server()\n", "")
        + "\nnode.create_timer(0.5, lambda: ask('map'))\n"
        + POOL
    )
    run = play(ticks=9, simulated=True, node=code)
    assert run.pace.paced_ticks == 0, run.lines
    assert sorted(run.heard[:2]) == ["accepted at 5", "feedback at 5"]
    assert run.heard[2:] == ["feedback at 5", "feedback at 6", "4: map at 7 at 7"]
