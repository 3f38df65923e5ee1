"""Loops in a callback that wait for another callback."""

import pytest

from gz_course.grader.feedback.slips import slips

NODE = """\
class Mapper(Node):
    def __init__(self):
        self.create_subscription(Odometry, "/odom", self.on_odom, 10)
        self.create_timer(0.2, self.drive)
        self.yaw = 0.0

    def on_odom(self, message):
        self.yaw = heading(message.pose.pose.orientation)

    def drive(self):
        command, error = self.plan()
        {loop}
        self.commands.publish(command)
"""


@pytest.mark.parametrize(
    "loop",
    [
        "while True:\n            error = -error",
        "while True:\n            print(error)",
        "while True:\n            self.store(error, Twist())",
        "while self.get_clock().now() - self.begin < Duration(seconds=5):\n            self.say(Twist())",
    ],
)
def test_a_loop_that_keeps_the_executor_is_found(loop):
    (found,) = slips(NODE.format(loop=loop).encode())
    assert "keeps the executor" in found["said"]


@pytest.mark.parametrize(
    "loop",
    [
        "while abs(self.goal - self.yaw) > 0.1:\n            self.commands.publish(command)",
        "while abs(error) > 0.1:\n            self.commands.publish(command)\n            error = self.goal - self.yaw",
    ],
)
def test_a_loop_that_waits_for_another_callback_is_found(loop):
    (found,) = slips(NODE.format(loop=loop).encode())
    assert "waits for self.yaw, which only another callback sets" in found["said"]
    assert slips(NODE.format(loop=f"{loop}\n        MultiThreadedExecutor()").encode()) == []


@pytest.mark.parametrize(
    "loop",
    [
        "while error > pi:\n            error -= 2 * pi",
        "while error > self.yaw:\n            error = error - 2 * pi",
        "while self.yaw > self.limit and self.cells:\n            self.cells.pop()",
        "while self.yaw > 0:\n            break",
    ],
)
def test_a_loop_that_gets_on_is_none(loop):
    assert slips(NODE.format(loop=loop).encode()) == []
