"""A timer that ends itself, and a message that is kept once and for all by setdefault()."""

import pytest

from gz_course.grader.feedback.suspects import suspects

NODE = """\
class Follower(Node):
    def __init__(self):
        self.poses = {}
        self.create_subscription(Odometry, "odom", self.heard, 10)
        self.timer = self.create_timer(0.1, self.steer)

    def heard(self, who, message):
        place = message.pose.pose.position
        self.poses[who] = (place.x, place.y)

    def steer(self):
        if self.distance() < self.gap:
            return
        self.publisher.publish(self.command())
"""


def said(source, about):
    return [each["said"] for each in suspects(source.encode()) if each["about"] == about]


@pytest.mark.parametrize("ends", ["self.timer.cancel()", "self.destroy_timer(self.timer)"])
def test_a_timer_that_ends_itself(ends):
    assert not said(NODE, "silenced")
    ended = NODE.replace("            return\n", f"            {ends}\n            return\n")
    assert f"{ends} ends the timer for good" in said(ended, "silenced")[0]
    assert not said(ended + "        self.timer.reset()\n", "silenced")


@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("self.poses.setdefault(who, (place.x, place.y))", True),
        ("self.poses.setdefault(who, []).append(place)", False),
        ("self.first.setdefault(who, place)", False),
        ("names.setdefault(who, place)", False),
    ],
)
def test_a_message_that_is_kept_once(line, found):
    changed = NODE.replace("self.poses[who] = (place.x, place.y)", line)
    assert any("setdefault() sets what is not set yet" in each for each in said(changed, "first_kept")) == found
