"""Several processes of one submission in lock-step: what they tell each other arrives in the same order every time."""

import pytest

COUNTER = """
numbers = node.create_publisher(Int32, "/numbers", 10)
count = 0
def tick():
    global count
    count += 1
    numbers.publish(Int32(data=count))
node.create_timer(0.1, tick)
rclpy.spin(node)
"""
ECHO = """
said = node.create_publisher(String, "/said", 10)
last = 0
def hear(message):
    global last
    last = message.data
def tick():
    said.publish(String(data=f"{name} {last} at {node.get_clock().now().nanoseconds // 10**8}"))
node.create_subscription(Int32, "/numbers", hear, 10)
node.create_timer(0.1, tick)
rclpy.spin(node)
"""


def said(play, **files):
    """What is said in a run that is in step."""
    run = play(**files)
    assert run.pace.paced_ticks == 0, run.lines
    return run.heard


def test_a_message_to_another_process_arrives_after_what_was_due_at_the_same_time(play):
    """Both timers are due when the clock says so; the number is on its way only afterwards."""
    heard = said(play, counter=COUNTER, echo=ECHO)
    assert heard == [f"echo {n} at {n + 1}" for n in range(10)]


def test_a_chain_of_three_processes_is_through_within_a_tick(play):
    relay = """
    out = node.create_publisher(Int32, "/doubled", 10)
    node.create_subscription(Int32, "/numbers", lambda m: out.publish(Int32(data=2 * m.data)), 10)
    rclpy.spin(node)
    """
    end = """
    said = node.create_publisher(String, "/said", 10)
    def hear(message):
        said.publish(String(data=f"{message.data} at {node.get_clock().now().nanoseconds // 10**8}"))
    node.create_subscription(Int32, "/doubled", hear, 10)
    rclpy.spin(node)
    """
    heard = said(play, counter=COUNTER, relay=relay, end=end)
    assert heard == [f"{2 * n} at {n}" for n in range(1, 11)]


def test_several_messages_at_once_arrive_in_the_order_of_publishing(play):
    burst = """
    outs = [node.create_publisher(Int32, f"/n{i}", 10) for i in range(3)]
    def tick():
        for i in (2, 0, 1):
            message = Int32(data=i)
            outs[i].publish(message)
            message.data = 99  # what happens to it later is not what was published
    node.create_timer(0.1, tick)
    rclpy.spin(node)
    """
    ear = """
    said = node.create_publisher(String, "/said", 10)
    for i in range(3):
        node.create_subscription(Int32, f"/n{i}", lambda m: said.publish(String(data=str(m.data))), 10)
    rclpy.spin(node)
    """
    assert "".join(said(play, ticks=4, burst=burst, ear=ear)) == "201" * 4


def test_a_service_is_asked_and_answers_within_a_tick(play):
    server = """
    count = 0
    def answer(request, response):
        global count
        count += 1
        response.success, response.message = True, f"answer {count}"
        return response
    node.create_service(Trigger, "/ask", answer)
    rclpy.spin(node)
    """
    client = """
    said = node.create_publisher(String, "/said", 10)
    asked = node.create_client(Trigger, "/ask")
    asked.wait_for_service()
    def hear(future):
        now = node.get_clock().now().nanoseconds // 10**8
        said.publish(String(data=f"{name} {future.result().message} at {now}"))
    def tick():
        asked.call_async(Trigger.Request()).add_done_callback(hear)
    node.create_timer(0.1, tick)
    rclpy.spin(node)
    """
    heard = said(play, ticks=3, server=server, alice=client, bob=client)
    assert heard == [
        f"{who} answer {2 * tick + turn} at {tick + 1}" for tick in range(3) for turn, who in ((1, "alice"), (2, "bob"))
    ]


def test_time_does_not_begin_before_the_service_of_a_slow_process_is_found(play):
    server = """
    sum(range(2 * 10**7))
    def answer(request, response):
        response.success = True
        return response
    node.create_service(Trigger, "/ask", answer)
    rclpy.spin(node)
    """
    client = """
    said = node.create_publisher(String, "/said", 10)
    asked = node.create_client(Trigger, "/ask")
    asked.wait_for_service()
    now = node.get_clock().now().nanoseconds
    node.create_timer(0.1, lambda: said.publish(String(data=f"found at {now}")))
    rclpy.spin(node)
    """
    run = play(ticks=2, server=server, client=client)
    assert (run.heard, run.pace.paced_ticks) == (["found at 0"] * 2, 0)


def test_a_call_that_blocks_a_pool_thread_is_answered(play):
    server = """
    def answer(request, response):
        response.success = request.data
        return response
    node.create_service(SetBool, "/ask", answer)
    rclpy.spin(node)
    """
    client = """
    from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
    from rclpy.executors import MultiThreadedExecutor
    said = node.create_publisher(String, "/said", 10)
    asked = node.create_client(SetBool, "/ask", callback_group=MutuallyExclusiveCallbackGroup())
    def tick():
        answer = asked.call(SetBool.Request(data=True))
        said.publish(String(data=f"{answer.success} at {node.get_clock().now().nanoseconds // 10**8}"))
    node.create_timer(0.1, tick, callback_group=MutuallyExclusiveCallbackGroup())
    asked.wait_for_service()
    executor = MultiThreadedExecutor(3)
    executor.add_node(node)
    executor.spin()
    """
    assert said(play, ticks=4, server=server, client=client) == [f"True at {n}" for n in range(1, 5)]


def test_a_parameter_of_another_node_is_set(play):
    setter = """
    from rcl_interfaces.srv import SetParameters
    from rclpy.parameter import Parameter
    asked = node.create_client(SetParameters, "/speaker/set_parameters")
    asked.wait_for_service()
    count = 0
    def tick():
        global count
        count += 1
        parameter = Parameter("count", value=count).to_parameter_msg()
        asked.call_async(SetParameters.Request(parameters=[parameter]))
    node.create_timer(0.1, tick)
    rclpy.spin(node)
    """
    speaker = """
    node.declare_parameter("count", 0)
    said = node.create_publisher(String, "/said", 10)
    def tick():
        said.publish(String(data=str(node.get_parameter("count").value)))
    node.create_timer(0.1, tick)
    rclpy.spin(node)
    """
    assert said(play, ticks=5, setter=setter, speaker=speaker) == ["0", "1", "2", "3", "4"]


def test_processes_that_were_not_told_to_hold_are_told_when_there_are_two(play):
    played = play(counter=COUNTER, echo=ECHO, holding=False)
    assert played.heard == [f"echo {n} at {n + 1}" for n in range(10)]


def test_a_process_that_ends_on_its_way_leaves_the_others_in_step(play):
    dying = """
    count = 0
    def tick():
        global count
        count += 1
        if count == 3:
            raise SystemExit
    node.create_subscription(Int32, "/numbers", lambda m: None, 10)
    node.create_timer(0.1, tick)
    rclpy.spin(node)
    """
    played = play(counter=COUNTER, echo=ECHO, dying=dying)
    assert played.heard == [f"echo {n} at {n + 1}" for n in range(10)]
    assert played.pace.paced_ticks == 0


@pytest.mark.proof
def test_a_process_that_cannot_be_followed_is_paced_and_holds_nobody_up(play):
    sleeper = """
    import select
    node.create_timer(0.1, lambda: select.poll().poll(600_000))
    rclpy.spin(node)
    """
    played = play(ticks=3, counter=COUNTER, echo=ECHO, sleeper=sleeper)
    assert played.pace.paced_ticks
    assert played.heard[:1] == ["echo 0 at 1"]
