"""Conditions and timers that make the rhythm of a topic."""

import pytest

from gz_course.grader.feedback.facts.rhythm import rhythm

NODE = """
class Mapper(Node):
    def __init__(self):
        self.maps = self.create_publisher(OccupancyGrid, "map", 10)
        self.create_timer(0.2, self.drive)
        {timer}
    def on_odom(self, message):
        self.pose = message.pose.pose
    def send(self):
        self.maps.publish(OccupancyGrid())
    def drive(self):
        if self.pose is None:
            return
        {drive}
        self.path = []
"""


@pytest.mark.parametrize(
    ("timer", "drive", "said"),
    [
        ("", "if not self.path: self.send()", "self.send() is called only while `not self.path` holds (line 14)"),
        ("", "if self.left > 1: return\n        self.send()", "only while `self.left > 1` does not hold (line 14)"),
        ("", "if self.a: self.send()\n        else: self.send()", ""),
        ("", "if self.pose: self.send()", ""),
        ("self.create_timer(2.0, self.send)", "if not self.path: self.send()", ""),
    ],
)
def test_a_topic_that_is_published_on_a_condition(timer, drive, said):
    found = [each for each in rhythm(NODE.format(timer=timer, drive=drive).encode()) if "period" not in each]
    assert [each["topic"] for each in found] == ["/map"] * bool(said)
    assert all(said in each["said"] for each in found)


def test_the_timer_that_publishes():
    found = rhythm(NODE.format(timer="self.create_timer(2.0, self.send)", drive="pass").encode())
    assert [(each["line"], each["period"]) for each in found] == [(6, 2.0)]
    assert "publishes once in 2 s" in found[0]["said"]
