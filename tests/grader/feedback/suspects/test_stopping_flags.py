"""Flags that stop a robot and are never set back."""

import pytest

from gz_course.grader.feedback.suspects import suspects

WRONG = """\
class Follower(Node):
    def __init__(self):
        self.arrived = False

    def steer(self):
        command = Twist()
        if distance < 1.2:
            self.arrived = True
        if self.arrived:
            self.publisher.publish(Twist())
            return
        command.linear.x = distance - 1.2
        self.publisher.publish(command)
"""
RETURN = "            self.publisher.publish(Twist())\n            return\n"


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ("self.arrived:", "self.arrived:", True),
        ("self.arrived:", "self.front is None or self.arrived:", True),
        (RETURN, "            return\n", True),
        (RETURN, "            command.linear.x = 0.0\n            return\n", True),
        ("= distance - 1.2", "= 0.0 if self.arrived else distance", True),
        ("    self.arrived = True", "    self.arrived = True\n        else:\n            self.arrived = False", False),
        ("self.arrived:", "not self.arrived:", False),
        ("Follower(Node)", "Follower(ActionServer())", False),
    ],
)  # fmt: skip
def test_a_flag_for_ever(old, new, found):
    said = [each["said"] for each in suspects(WRONG.replace(old, new).encode()) if each["about"] == "stopped"]
    assert bool(said) == found and all("self.arrived becomes True here" in each for each in said)
