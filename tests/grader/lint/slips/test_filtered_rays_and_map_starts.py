"""Rays that are numbered after some were left out, and maps from which the start of the robot is subtracted."""

import ast

import pytest

from gz_course.grader.lint.slips import slips
from gz_course.grader.lint.slips.geometry import filtered_rays, map_starts, sorted_rays

STEP = "a = i * scan.angle_increment"
ARRAY = "r = np.array(scan.ranges)"
ANGLES = "angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))"


def found(room, *lines):
    text = "class A:\n    def on_scan(self, scan):\n" + "".join(f"        {line}\n" for line in lines)
    return [place for look in room.LOOKS for place in look(ast.parse(text))]


@pytest.mark.parametrize(
    "lines",
    [
        ("ranges = np.array(scan.ranges)", "ranges = ranges[np.isfinite(ranges)]", ANGLES),
        (ARRAY, "ok = (r > 0) & (r < 3)", "r = r[ok]", "a = np.arange(r.size) * scan.angle_increment"),
        ("ranges = [r for r in scan.ranges if isfinite(r)]", ANGLES),
        ("ranges = list(filter(isfinite, scan.ranges))", "for i in range(len(ranges)):", f"    {STEP}"),
        ("for r in scan.ranges:", "    if r < 3:", "        ranges.append(r)", ANGLES),
        (ARRAY, "r = r[r < 3]", "i = np.arange(len(r))", STEP),
        (ARRAY, "r = r[r < 3]", "a = np.linspace(scan.angle_min, scan.angle_max, len(r))"),
    ],
)  # fmt: skip
def test_numbers_of_what_is_left_are_no_numbers_of_rays(lines):
    ((_, said),) = found(filtered_rays, *lines)
    assert "numbers only the rays that line" in said


@pytest.mark.parametrize(
    "lines",
    [
        ("ranges = np.array(scan.ranges)", ANGLES, "ok = ranges < 3", "ranges, angles = ranges[ok], angles[ok]"),
        ("ranges = np.array(scan.ranges)", ANGLES, "ranges = ranges[np.isfinite(ranges)]"),
        ("ranges = np.array(scan.ranges)", "ranges = ranges[::2]", ANGLES),
        ("good = [r for r in scan.ranges if r < 3]", "ranges = scan.ranges", ANGLES),
        ("ranges = [r if r < 3 else 3.0 for r in scan.ranges]", ANGLES),
    ],
)
def test_angles_of_all_rays_are_not_named(lines):
    assert found(filtered_rays, *lines) == []


def test_a_place_among_masked_points_is_no_number_of_a_ray():
    chosen = ("side = y > 0", "x, y = x[side], y[side]", "r = np.hypot(x, y)", "n = np.argmin(r)")
    ((_, said),) = found(sorted_rays, *chosen, "a = scan.angle_min + n * scan.angle_increment")
    assert "n is a place among those that side has left" in said
    assert found(sorted_rays, *chosen, "a = np.arctan2(y[n], x[n])") == []


SUBTRACTS = """
class Mapper(Node):
    def __init__(self):
        self.maps = self.create_publisher(OccupancyGrid, "/map", 10)
        self.create_subscription(Odometry, "/odom", self.on_odom, 10)
        self.start = None

    def on_odom(self, message):
        p = message.pose.pose.position
        if self.start is None:
            self.start = p.x, p.y
        self.pose = p.x - self.start[0], p.y - self.start[1]
"""


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("", ""),
        ("self.pose = p.x - self", "x = p.x\n        self.pose = x - self"),
        ("self.start is None", "not self.start"),
        ("p.x - self.start[0], p.y - self.start[1]", "(p.x - self.start[0]) / 0.1, (p.y - self.start[1]) / 0.1"),
    ],
)  # fmt: skip
def test_a_start_that_is_subtracted(old, new):
    ((_, said),) = map_starts.LOOKS[0](ast.parse(SUBTRACTS.replace(old, new, 1) if old else SUBTRACTS))
    assert "subtracts the first position from all others" in said


@pytest.mark.parametrize(
    "text",
    [
        SUBTRACTS + "        self.x = p.x\n",
        SUBTRACTS + "        self.place = self.pose[0] + self.start[0]\n",
        SUBTRACTS.replace("OccupancyGrid", "Path"),
        SUBTRACTS.replace("if self.start is None:", "if message.header.stamp.sec % 2:"),
    ],
)
def test_a_start_with_another_use(text):
    assert list(map_starts.LOOKS[0](ast.parse(text))) == []


@pytest.mark.parametrize(
from gz_course.grader.lint.slips import slips
from gz_course.grader.lint.slips.geometry import filtered_rays, map_starts, sorted_rays
