"""Averages over many scans by which a node steers are found; short ones are not."""

import pytest

from gz_course.grader.feedback.suspects import suspects

FILE = """\
from collections import deque

from sensor_msgs.msg import LaserScan

KEPT = {kept}


class Follower:
    def __init__(self):
        self.last = deque(maxlen=KEPT)
        self.smooth = 0.0

    def on_scan(self, scan):
        nearest = min(scan.ranges)
        {body}
        command.angular.z = 2.0 * (distance - 0.6)
"""
MEAN = "self.last.append(nearest)\n        distance = sum(self.last) / len(self.last)"
POPPED = "self.last.append(nearest)\n        if len(self.last) > 30:\n            self.last.pop(0)\n        "


@pytest.mark.parametrize(
    ("body", "kept", "words"),
    [
        (MEAN, 20, "of the last 20 values"),
        (MEAN, 3, ""),
        (POPPED + "distance = np.mean(self.last)", 1, "of the last 30 values"),
        ("self.smooth = 0.95 * self.smooth + 0.05 * nearest\n        distance = self.smooth", 1, "comes late"),
        ("self.smooth = 0.5 * self.smooth + 0.5 * nearest\n        distance = self.smooth", 1, ""),
        ("self.smooth += 0.04 * (nearest - self.smooth)\n        distance = self.smooth", 1, "comes late"),
        ("self.smooth += 0.04 * nearest\n        distance = self.smooth", 1, ""),
        ("self.smooth += (nearest - self.smooth) / 20\n        distance = self.smooth", 1, "comes late"),
        ("self.smooth = self.smooth + 0.05 * (nearest - self.smooth)\n        distance = self.smooth", 1, "comes late"),
        ("self.smooth = (19 * self.smooth + nearest) / 20\n        distance = self.smooth", 1, "comes late"),
        ("self.smooth = (self.smooth + nearest) / 2\n        distance = self.smooth", 1, ""),
        ("distance = 0.9 * self.smooth + 0.1 * nearest\n        self.smooth = distance", 1, "comes late"),
        ("self.kept = (self.kept + [nearest])[-12:]\n        distance = np.mean(self.kept)", 1, "of the last 12"),
        ("self.last.append(nearest)\n        distance = np.mean([r for r in self.last])", 12, "of the last 12"),
        ("self.last.append(nearest)\n        distance = self.last[0]", 12, "the oldest of 12 values"),
        ("self.last.append(nearest)\n        distance = self.last[-1]", 12, ""),
        (
            "self.last.append(nearest)\n        distance = self.last.popleft() if len(self.last) > 8 else 1.0",
            1,
            "the oldest of 8 values",
        ),
        (POPPED[:-8].replace("self.last.pop(0)", "distance = self.last.pop(0)"), 1, "the oldest of 30 values"),
    ],
)
def test_averages_over_time(body, kept, words):
    said = [each["said"] for each in suspects(FILE.format(body=body, kept=kept).encode()) if each["about"] == "delay"]
    assert len(said) == bool(words) and all(words in each for each in said), said


def test_an_average_of_the_parameter_is_no_delay_of_the_lidar():
    body = "wanted = self.get_parameter('distance').value\n        self.smooth += 0.04 * (wanted - self.smooth)"
    found = suspects(FILE.format(body=f"{body}\n        distance = nearest - self.smooth", kept=1).encode())
    said = {each["about"]: each["said"] for each in found}
    assert "delay" not in said and "take effect over many scans" in said["seldom distance"]


@pytest.mark.parametrize(
    ("body", "found"),
    [
        ("side = [r for r in scan.ranges if r < 5]\n        distance = max(side)", True),
        ("distance = np.max(scan.ranges[10:20])", True),
        ("side = [r for r in scan.ranges if r < 5]\n        distance = min(side) if max(side) < 9 else 9", False),
        ("distance = max(0.1, nearest)", False),
    ],
)
def test_the_farthest_range(body, found):
    text = FILE.format(body=body, kept=3).replace("nearest = min(scan.ranges)", "nearest = scan.ranges[90]")
    assert [each["about"] for each in suspects(text.encode()) if each["about"] == "farthest"] == ["farthest"] * found
