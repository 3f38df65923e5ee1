"""Suspects of a node that keeps a distance, and callbacks that keep their first message."""

import pytest

from gz_course.grader.feedback.suspects import suspects

RIGHT = """\
class Follower(Node):
    def on_front(self, message):
        self.front_x = message.pose.pose.position.x

    def steer(self):
        if self.front_x is None:
            return
        distance = math.hypot(dx, dy)
        error = distance - self.gap
        yaw = 2 * atan2(self.own.orientation.z, self.own.orientation.w)
        command = Twist()
        if error > 0.02:
            command.linear.x = 1.5 * error
        command.angular.z = atan2(left, ahead)
"""


@pytest.mark.parametrize(
    ("old", "new", "about", "words"),
    [
        ("distance - self.gap", "self.gap - distance", "gap", "the distance minus the gap"),
        ("error > 0.02", "error < 0.02", "gap", "drives only where error < 0.02"),
        ("error > 0.02", "0.02 > error", "gap", "does not hold where it is behind"),
        ("= 1.5 * error", "= float(int(1.5 * error))", "whole_speed", "every speed below 1 m/s is 0"),
        ("self.front_x = m", "self.front_x += m", "gap", "grows by the whole position"),
        (
            "        self.front_x = m",
            "        if self.front_x is not None:\n            return\n        self.front_x = m",
            "first_kept",
            "returns here as soon as self.front_x is set",
        ),
        ("atan2(left, ahead)", "atan2(ahead, left)", "heading", "atan2 takes y first"),
        ("atan2(self.own.orientation.z", "atan2(self.own.orientation.y", "heading", "y is nearly 0 on flat ground"),
    ],
)
def test_a_suspect(old, new, about, words):
    assert suspects(RIGHT.encode()) == []
    found = suspects(RIGHT.replace(old, new).encode())
    assert words in " ".join(each["said"] for each in found if each["about"] == about)


def test_a_speed_with_a_minus_sign_is_no_suspect():
    turned = RIGHT.replace("distance - self.gap", "self.gap - distance").replace("= 1.5 * error", "= -1.5 * error")
    assert suspects(turned.encode()) == []
