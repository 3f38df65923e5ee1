"""Callbacks that wait, and the oldest of several kept poses that is taken for the newest."""

import pytest

from gz_course.grader.feedback.suspects import suspects

NODE = """\
from time import sleep, time


class Mapper(Node):
    def __init__(self):
        self.create_subscription(Odometry, "/odom", self.on_odom, 10)
        self.create_timer(0.2, self.drive)
        self.poses = []

    def on_odom(self, message):
        self.poses.append(message.pose.pose)

    def drive(self):
        x, y = self.poses[-1]
        self.turn(x)

    def turn(self, angle):
        self.commands.publish(self.command(angle))
"""


def found(old: str, new: str, about: str) -> list[str]:
    text = NODE.replace(old, new)
    assert text != NODE
    return [each["said"] for each in suspects(text.encode()) if each["about"] == about]


def test_a_right_node_has_none():
    assert suspects(NODE.encode()) == []


PUBLISH = "        self.commands.publish(self.command(angle))"


@pytest.mark.parametrize(
    ("waits", "words"),
    [
        ("sleep(angle / 1.2)", "sleep(angle / 1.2) sleeps in a callback (turn)"),
        ("self.get_clock().sleep_for(Duration(seconds=1))", "sleeps in a callback (turn)"),
        ("while time() < end:\n            pass", "waits in a callback (turn)"),
    ],
)
def test_a_callback_that_waits_is_found(waits, words):
    assert words in found(PUBLISH, f"{PUBLISH}\n        {waits}", "sleep")[0]


@pytest.mark.parametrize("right", ["sleep(0.01)", "while self.queue:\n            self.queue.pop()"])
def test_a_callback_that_does_not_wait_is_none(right):
    assert found(PUBLISH, f"{PUBLISH}\n        {right}", "sleep") == []


def test_who_has_several_threads_may_sleep():
    assert found(PUBLISH, f"{PUBLISH}\n        sleep(angle)\n        MultiThreadedExecutor()", "sleep") == []


def test_the_oldest_pose_is_found():
    assert "self.poses[0] is the oldest pose" in found("self.poses[-1]", "self.poses[0]", "pose")[0]
    assert "min(self.poses) is the oldest pose" in found("self.poses[-1]", "min(self.poses)", "pose")[0]


@pytest.mark.parametrize("right", ["self.poses[0] - self.poses[-1]", "self.start(self.poses[0])"])
def test_the_oldest_pose_beside_the_newest_is_none(right):
    assert found("self.poses[-1]", right, "pose") == []
