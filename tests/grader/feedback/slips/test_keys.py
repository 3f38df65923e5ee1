"""Keys of a dictionary that are read and that nothing sets, and those that are set somewhere."""

import pytest

from gz_course.grader.feedback.slips import slips

NODE = """\
import rclpy
from rclpy.node import Node


class Follower(Node):
    def __init__(self):
        super().__init__("follower")
        self.poses = {}
        self.create_subscription(Odometry, "odom", lambda m: self.store("own", m), 10)
        self.create_subscription(Odometry, "front/odom", lambda m: self.store("front", m), 10)
        self.create_timer(0.1, self.steer)

    def store(self, who, message):
        self.poses[who] = message.pose.pose

    def steer(self):
        if len(self.poses) < 2:
            return
        own, front = self.poses["own"], self.poses["front"]
        self.drive(own, front)


def main():
    rclpy.init()
    rclpy.spin(Follower())
"""


def said(source):
    return " ".join(each["said"] for each in slips(source.encode()))


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('self.store("own", m)', 'self.store("front", m)'),
        ('self.poses["own"], ', 'self.poses.get("me"), '),
    ],
)
def test_a_key_that_nothing_sets(old, new):
    assert "nothing sets" not in said(NODE)
    key = "'own'" if "store" in old else "'me'"
    assert f"nothing sets self.poses[{key}]: what is set is" in said(NODE.replace(old, new))


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("self.poses[who] = message", "self.poses[self.names[who]] = message"),
        ("self.poses = {}", "self.poses = {'own': None}"),
        (
            "        self.poses[who] = message",
            "        self.poses.update({who: message})\n        self.poses[who] = message",
        ),
        ("        self.poses[who] = message", "        fill(self.poses)\n        self.poses[who] = message"),
        ("self.create_timer(0.1, self.steer)", "self.create_timer(0.1, self.steer)\n        self.way = self.store"),
    ],
)
def test_keys_that_may_be_set_elsewhere(old, new):
    changed = NODE.replace('self.store("own", m)', 'self.store("front", m)').replace(old, new)
    assert "nothing sets" not in said(changed)
