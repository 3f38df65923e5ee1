"""Attributes that stay None for ever, although a callback waits for them."""

import pytest

from gz_course.grader.feedback.slips import slips

RIGHT = """\
import rclpy
from rclpy.node import Node


class Follower(Node):
    def __init__(self):
        super().__init__("follower")
        self.own = None
        self.front: Pose | None = None

    def on_own(self, message):
        self.own = message.pose.pose

    def on_front(self, message):
        self.front = message.pose.pose

    def steer(self):
        if self.own is None or self.front is None:
            return
        self.publisher.publish(self.command())


def main():
    rclpy.init()
    rclpy.spin(Follower())


main()
"""


def test_a_right_file_has_none():
    assert slips(RIGHT.encode()) == []


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("self.front = message", "self.own = message", "on_own and on_front both set self.own"),
        ("self.front = message.pose.pose", "pass", "self.front is None for ever"),
    ],
)
def test_an_attribute_that_nobody_sets(old, new, words):
    assert words in " ".join(each["said"] for each in slips(RIGHT.replace(old, new).encode()))


def test_a_coroutine_or_another_object_sets_it():
    assert slips(RIGHT.replace("def on_front", "async def on_front").encode()) == []
    other = RIGHT.replace("self.front = message.pose.pose", "pass") + "\nnode.front = 1\n"
    assert not any("for ever" in each["said"] for each in slips(other.encode()))


@pytest.mark.parametrize(
    ("later", "words"),
    [("pass", ["self.last_error stays 0.0"]), ("self.last_error = error", []), ("self.last_error += 1", [])],
)
def test_a_previous_value_that_is_never_set(later, words):
    code = RIGHT.replace("self.own = None\n", "self.own = None\n        self.last_error = 0.0\n").replace(
        "        self.publisher", f"        change = error - self.last_error\n        {later}\n        self.publisher"
    )
    said = [place["said"] for place in slips(code.encode())]
    assert len(said) == len(words) and all(word in each for word, each in zip(words, said, strict=True)), said
