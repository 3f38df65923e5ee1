"""Searches for the nearest range that keep or drop the wrong one are found; right ones are not."""

import pytest

from gz_course.grader.feedback.suspects import suspects

FILE = """\
import math


class Follower:
    def __init__(self):
        self.best = math.inf
        self.distance = 0.6

    def on_scan(self, scan):
        best, n = math.inf, len(scan.ranges)
        {search}
        command.angular.z = 2.0 * (best - 0.6)
"""
LOOP = "for i, r in enumerate(scan.ranges):\n            "
IN_LINE = "if r < best:\n                best = r"


@pytest.mark.parametrize(
    ("search", "words"),
    [
        (LOOP + IN_LINE, ""),
        (LOOP + "best = min(best, r)", ""),
        (LOOP + "if r < self.best:\n                self.best = r", "smallest range of all scans since the start"),
        (LOOP + "self.best = min(self.best, r)", "nothing sets it back"),
        ("self.best = math.inf\n        " + LOOP + "self.best = min(self.best, r)", ""),
        (LOOP + IN_LINE + "\n                break", "break ends the search at the first ray"),
        (LOOP + "if math.isfinite(r):\n                best = r", "it is the last of them, not the nearest"),
        (LOOP + "if -0.2 < i * 0.01 < 2.5 and r < scan.range_max:\n                best = r", "it is the last of them"),
        (LOOP + "if i == 90:\n                best = r\n                break", ""),
        (LOOP + "if i == 90:\n                best = r", ""),
        (LOOP + "if abs(i * 0.01 - 1.57) < 0.02:\n                best = r", ""),
        ("best = min(r for r in scan.ranges if r > self.last_distance)", ""),
        ("best = min(r for r in scan.ranges if scan.range_min < r < scan.range_max)", ""),
        ("best = min(r for r in scan.ranges if 0.5 < r < scan.range_max)", "ranges below 0.5 are left out"),
        ("best = min(r for r in scan.ranges if 0.1 < r < 1.0)", "ranges beyond 1.0 are left out"),
        ("best = min(r for r in scan.ranges if r > self.distance)", "ranges below self.distance = 0.6 m are left out"),
        (LOOP + "if r > 1.2:\n                continue\n            best = min(best, r)", "ranges beyond 1.2"),
        (LOOP + "if r < 0.5:\n                self.near = True\n            best = min(best, r)", ""),
    ],
)
def test_searches(search, words):
    said = [each["said"] for each in suspects(FILE.format(search=search).encode())]
    assert len(said) == bool(words) and all(words in each for each in said), said


@pytest.mark.parametrize(
    ("test", "part", "words"),
    [
        (
            "self.side == 'left'",
            "n // 4:n // 2",
            "is taken for the left, and looks to the right, from -90 to 0",
        ),
        ("self.side == 'right'", "len(scan.ranges) // 2:", "is taken for the right, and looks to the left"),
        ("self.side == 'left'", "n // 2:3 * n // 4", ""),
        ("self.side == 'left'", "10:20", ""),
        ("self.count > 3", "n // 4:n // 2", ""),
    ],
)
def test_parts_of_a_scan(test, part, words):
    search = f"if {test}:\n            best = min(scan.ranges[{part}])\n        else:\n            pass"
    found = suspects(FILE.format(search=search).encode())
    said = [each["said"] for each in found if each["about"].startswith("part")]
    assert len(said) == bool(words) and all(words in each for each in said), said


@pytest.mark.parametrize(
    ("speed", "words"),
    [
        ("min(limit, speed)", ""),
        ("max(limit, speed)", "what limits a speed is min(...)"),
        ("max(self.get_parameter('speed_limit').value, speed)", "is self.get_parameter('speed_limit').value at least"),
        ("max(0.0, min(limit, speed))", ""),
        ("min(max(limit, 0.1), speed)", ""),
    ],
)
def test_speed_limits(speed, words):
    search = f"limit = self.get_parameter('speed_limit').value\n        command.linear.x = {speed}"
    found = suspects(FILE.format(search=search).encode())
    said = [each["said"] for each in found if each["about"] == "speed limit"]
    assert len(said) == bool(words) and all(words in each for each in said), said


@pytest.mark.parametrize(
    ("later", "words"), [("pass", "self.corner = True stays so for ever"), ("self.corner = False", "")]
)
def test_flags(later, words):
    search = (
        f"if self.corner:\n            command.angular.z = 1.0\n        if best < 0.5:\n"
        f"            self.corner = True\n        else:\n            {later}"
    )
    code = FILE.format(search=search).replace("self.distance = 0.6", "self.corner = False")
    said = [each["said"] for each in suspects(code.encode()) if each["about"] == "flag for ever"]
    assert len(said) == bool(words) and all(words in each for each in said), said


def test_a_list_that_grows_from_scan_to_scan_is_found():
    file = FILE.replace("self.best = math.inf", "self.near = []")
    kept = LOOP + "self.near.append(r)\n        best = min(self.near)"
    (said,) = [each["said"] for each in suspects(file.format(search=kept).encode())]
    assert "adds to self.near, which still holds the rays of all scans before" in said
    for start in ("self.near = []", "self.near.clear()"):
        assert suspects(file.format(search=f"{start}\n        {kept}").encode()) == []


ERROR = """\
def on_scan(self, scan):
    nearest = self.nearest(scan.ranges)
    error = nearest - self.distance
    command.angular.z = {rate}
"""


@pytest.mark.parametrize(
    ("rate", "words"),
    [
        ("2.0 * int(error)", "is a whole number of metres"),
        ("2.0 * round(nearest - self.distance)", "is a whole number of metres"),
        ("2.0 / error", "divides by the error"),
        ("self.gain / error", "divides by the error"),
        ("2.0 * round(error, 2)", ""),
        ("2.0 * (error - self.error) / 0.1", ""),
        ("2.0 * error / self.distance", ""),
    ],
)
def test_errors(rate, words):
    said = [each["said"] for each in suspects(ERROR.format(rate=rate).encode())]
    assert len(said) == bool(words) and all(words in each for each in said), said
