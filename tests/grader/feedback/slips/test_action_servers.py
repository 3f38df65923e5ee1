"""Mistakes with the callbacks of an action server, and of parameters, in a file that is right but for each."""

import pytest

from gz_course.grader.feedback.slips import slips

RIGHT = """\
import time
import rclpy
from rclpy.action import ActionServer
from rclpy.executors import MultiThreadedExecutor


class Server(rclpy.node.Node):
    def __init__(self):
        super().__init__("server")
        self.add_on_set_parameters_callback(self.on_change)
        self.server = ActionServer(
            self, Patrol, "patrol", self.execute, goal_callback=self.on_goal, cancel_callback=self.on_cancel
        )

    def on_change(self, parameters):
        return SetParametersResult(successful=True)

    def on_goal(self, goal):
        if not goal.waypoints:
            return GoalResponse.REJECT
        return GoalResponse.ACCEPT if goal.speed > 0 else GoalResponse.REJECT

    def on_cancel(self, handle):
        return CancelResponse.ACCEPT

    def execute(self, handle):
        while self.left() > 0.1:
            time.sleep(0.1)
        handle.succeed()
        return Patrol.Result()


def main():
    rclpy.init()
    rclpy.spin(Server(), MultiThreadedExecutor(4))


if __name__ == "__main__":
    main()
"""


def test_a_right_file_has_none():
    assert slips(RIGHT.encode()) == []


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (
            "            time.sleep(0.1)\n",
            "            time.sleep(0.1)\n            if handle.is_cancel_requested:\n                return\n",
            "this return gives no result",
        ),
        ("return CancelResponse.ACCEPT", "return True", "return CancelResponse.ACCEPT or CancelResponse.REJECT"),
        (
            "return CancelResponse.ACCEPT",
            "return GoalResponse.ACCEPT",
            "returns GoalResponse.ACCEPT, which is no answer",
        ),
        ("        return CancelResponse.ACCEPT", "        handle.stop()", "returns nothing, which is no answer"),
        ("return GoalResponse.REJECT\n", "return False\n", "goal_callback returns False"),
        ("return GoalResponse.ACCEPT if goal.speed > 0 else GoalResponse.REJECT", "return goal.speed > 0", "no answer"),
        ("        return Patrol.Result()\n", "", "execute returns nothing"),
        ("return Patrol.Result()\n", "return True\n", "execute returns `True`, and what it returns is the result"),
        (
            "return Patrol.Result()\n",
            "result = Patrol.Result()\n        return result.visited\n",
            "execute returns `result.visited`, and what it returns is the result",
        ),
        (", MultiThreadedExecutor(4)", "", "keeps the only thread"),
        (
            "self.execute, goal",
            "self.execute, handle_accepted_callback=lambda handle: print(handle), goal",
            "never calls",
        ),
        ("        while self.left", "        handle.succeed()\n        while self.left", "above the loop"),
        ("return SetParametersResult(successful=True)", "self.changed = parameters", "must return SetParametersResult"),
        ("return SetParametersResult(successful=True)", "return True", "must return SetParametersResult"),
    ],
)
def test_each_is_found(old, new, words):
    assert old in RIGHT
    assert words in " ".join(each["said"] for each in slips(RIGHT.replace(old, new, 1).encode()))


def test_a_coroutine_with_one_thread_is_right():
    changed = RIGHT.replace("def execute", "async def execute").replace(", MultiThreadedExecutor(4)", "")
    assert slips(changed.encode()) == []


def test_a_coroutine_that_never_awaits_keeps_the_only_thread():
    loop = "            self.publisher.publish(Twist())\n            time.sleep(0.1)\n"
    changed = RIGHT.replace("            time.sleep(0.1)\n", loop).replace("def execute", "async def execute")
    assert slips(changed.encode()) == []
    alone = changed.replace(", MultiThreadedExecutor(4)", "")
    assert "keeps the only thread" in slips(alone.encode())[0]["said"]
    assert slips(alone.replace("            time.sleep(0.1)", "            await self.pause(0.1)").encode()) == []


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("MultiThreadedExecutor(4)", "MultiThreadedExecutor(num_threads=1)", "keeps the only thread"),
        ("        return CancelResponse", "        handle.canceled()\n        return CancelResponse", "only answers"),
        ("time.sleep(0.1)", "rclpy.spin_once(self, timeout_sec=0.1)", "takes the node away from the executor"),
    ],
)
def test_what_a_callback_of_an_action_server_must_not_do(old, new, words):
    assert words in " ".join(each["said"] for each in slips(RIGHT.replace(old, new, 1).encode()))


SPEAKS = "            self.publisher.publish(Twist())\n            time.sleep(0.1)\n"
SPEAKING = RIGHT.replace("            time.sleep(0.1)\n", SPEAKS)


def test_a_loop_without_a_pause():
    assert slips(SPEAKING.encode()) == []
    alone = SPEAKING.replace("            time.sleep(0.1)\n", "")
    assert "publishes without a pause" in slips(alone.encode())[0]["said"]
    pause = "    def pause(self):\n        time.sleep(0.1)\n\n    def execute"
    helper = SPEAKING.replace("time.sleep(0.1)", "self.pause()", 1).replace("    def execute", pause)
    assert slips(helper.encode()) == []


@pytest.mark.parametrize("held", ["with self.lock:", "if self.lock.acquire():"])
def test_a_lock_that_is_held_during_a_loop(held):
    made = SPEAKING.replace("        self.server =", "        self.lock = threading.Lock()\n        self.server =")
    other = "    def on_odometry(self, message):\n        with self.lock:\n            self.place = message\n\n"
    both = made.replace("    def execute", f"{other}    def execute")
    assert slips(both.encode()) == []
    loop = "        while self.left() > 0.1:\n" + SPEAKS
    if held.startswith("with"):
        inside = f"        {held}\n" + "".join(f"    {line}\n" for line in loop.splitlines())
    else:
        inside = "        self.lock.acquire()\n" + loop + "        self.lock.release()\n"
    changed = both.replace(loop, inside)
    assert "self.lock is held during the whole loop, and on_odometry() waits" in slips(changed.encode())[0]["said"]


@pytest.mark.parametrize(("default", "found"), [("0.5", False), ("1", True), ("'0.5'", True), ("None", False)])
def test_a_value_of_a_parameter_of_another_type(default, found):
    text = (
        f"self.declare_parameter('v', {default})\nself.v = self.get_parameter('v').get_parameter_value().double_value\n"
    )
    assert any("double_value of the parameter v" in each["said"] for each in slips(text.encode())) == found
