"""Degrees with a gain per radian, centimetres, gains behind limits, wrong tuples and zeros for rays without a hit."""

import pytest

from gz_course.grader.feedback.suspects import suspects

FILE = """\
from math import degrees, isfinite, pi, radians

import numpy as np
from sensor_msgs.msg import LaserScan

GAIN = 2.0


class Follower:
    def on_scan(self, scan):
        rays = []
        for i, r in enumerate(scan.ranges):
            b = scan.angle_min + i * scan.angle_increment
            {ray}
        far = self.get_parameter("distance").value
        {body}
"""
TURN = "        command.angular.z = "
KEEPS = "if isfinite(r) and r > scan.range_min:\n                rays.append((r, {}))"
STEERS = "near, away = min(rays)\n        command.angular.z = GAIN * (near - far + {})"
RIGHT = {"ray": KEEPS.format("b"), "body": STEERS.format("away - pi / 2")}


def found(**changed):
    return [(each["about"], each["said"]) for each in suspects(FILE.format(**RIGHT | changed).encode())]


@pytest.mark.parametrize(
    "changed",
    [
        {},
        {"body": "d = degrees(b) - 90\n        command.angular.z = GAIN * radians(d)"},
        {"body": "d = degrees(b) - 90\n        command.angular.z = 0.03 * d + GAIN * (r - far)"},
        {"body": "d = b * 180 / pi\n        command.angular.z = GAIN * r if d > 80 else 0.0"},
        {"body": "command.angular.z = np.clip(2.0 * np.clip(r, -1.5, 1.5), -1.5, 1.5)"},
        {"body": "r, b = min([(r, b) for r in scan.ranges])\n" + TURN + "r"},
        {"body": "hits = [(b, r) for r in scan.ranges]\n        b, r = min(hits, key=last)\n" + TURN + "r"},
        {"ray": "r = r if isfinite(r) else 0.0\n            if r > 0.0:\n                rays.append((r, b))"},
    ],
    ids=str,
)
def test_right_ways(changed):
    assert found(**changed) == []


ZERO = "            rays.append((r, b))"


@pytest.mark.parametrize(
    ("changed", "about"),
    [
        ({"body": "d = degrees(b) - 90\n        command.angular.z = GAIN * (r - far + d)"}, "degrees"),
        ({"body": "d = 57.3 * b\n        d = b * 57.3 - 90\n" + TURN + "self.pid(r - far, d)"}, "degrees"),
        ({"ray": KEEPS.format("degrees(b)"), "body": "d = [b for r, b in rays]\n" + TURN + "GAIN * d[0]"},
         "degrees"),
        ({"body": "command.angular.z = GAIN * (r - 100 * self.get_parameter('distance').value)"}, "unit"),
        ({"body": "command.angular.z = GAIN * max(-1.5, min(1.5, r - far))"}, "limit"),
        ({"body": "w = np.clip(r - far, -1.5, 1.5)\n        command.angular.z = float(GAIN * w)"}, "limit"),
        ({"body": "hits = [(b, r) for r in scan.ranges]\n        b, r = min(hits)\n" + TURN + "r"}, "farthest"),
        ({"ray": KEEPS.replace("(r, {})", "(round(r), b)")}, "farthest"),
        ({"ray": f"r = r if isfinite(r) else 0.0\n{ZERO}"}, "zero"),
        ({"ray": f"if not isfinite(r):\n                r = 0.0\n{ZERO}"}, "zero"),
        ({"ray": "rays.append((r, b))", "body": "r = np.nan_to_num(r, posinf=0)\n" + TURN + "r"}, "zero"),
        ({"ray": "rays.append((r, b))", "body": "q[np.isinf(q)] = 0.0\n" + TURN + "min(q)"}, "zero"),
    ],
    ids=str,
)  # fmt: skip
def test_each_is_found(changed, about):
    places = found(**changed)
    assert about in [each for each, _ in places], places
