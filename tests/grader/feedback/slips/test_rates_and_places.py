"""Rates that are taken per nanosecond, and places in masked arrays that are taken for numbers of rays."""

import pytest

from gz_course.grader.feedback.slips import slips

FILE = """\
class Node:
    def on_scan(self, scan):
        now = self.get_clock().now().nanoseconds
        error = min(scan.ranges) - 1
        valid = scan.ranges > 0
        {body}
        self.last, self.error = now, error
"""
PASSED = "dt = now - self.last\n        "


def said(body):
    return [place["said"] for place in slips(FILE.format(body=body).encode())]


@pytest.mark.parametrize(
    "body",
    [
        f"{PASSED}self.rate = (error - self.error) / (dt / 1e9)",
        f"{PASSED}self.rate = (error - self.error) / (dt * 1e-9)",
        f"{PASSED}self.share = dt / self.period",
        f"{PASSED}self.late = dt > 100",
        "self.at = angles[valid][np.argmin(ranges[valid])]",
        "self.at = angles[np.argmin(ranges)]",
        "angles = angles[valid]\n        self.at = angles[np.argmin(ranges[valid])]",
        "self.at = angles[np.argmin(ranges[i])]",
    ],
)
def test_right_ways(body):
    assert said(body) == []


@pytest.mark.parametrize(
    ("body", "words"),
    [
        (f"{PASSED}self.rate = (error - self.error) / dt", "1e9 times too small"),
        ("self.rate = (error - self.error) / (now - self.last)", "1e9 times too small"),
        (f"{PASSED}change = error - self.error\n        self.rate = change / dt", "1e9 times too small"),
        (f"{PASSED}self.total += error * dt", "1e9 times too large"),
        ("self.at = angles[np.argmin(ranges[valid])]", "use angles[valid]"),
        ("near = ranges[valid]\n        k = np.argmin(near)\n        self.at = angles[k]", "use angles[valid]"),
    ],
)
def test_each_is_found(body, words):
    assert any(words in each for each in said(body)), said(body)
