"""Rays that are numbered after some were left out, and maps from which the start of the robot is subtracted."""

import ast

import pytest

from gz_course.grader.feedback.slips import ROOM, slips
from gz_course.grader.feedback.slips.geometry import map_starts, numbered_rays

STEP = "a = i * scan.angle_increment"
ARRAY = "r = np.array(scan.ranges)"
ANGLES = "angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))"


def found(room, *lines):
    text = "class A:\n    def on_scan(self, scan):\n" + "".join(f"        {line}\n" for line in lines)
    return [place for look in ROOM.of(room) for place in look(ast.parse(text))]


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
    ((_, said),) = found(numbered_rays, *lines)
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
    assert found(numbered_rays, *lines) == []


def test_a_place_among_masked_points_is_no_number_of_a_ray():
    chosen = ("side = y > 0", "x, y = x[side], y[side]", "r = np.hypot(x, y)", "n = np.argmin(r)")
    ((_, said),) = found(numbered_rays, *chosen, "a = scan.angle_min + n * scan.angle_increment")
    assert "n is a place among those that side has left" in said
    assert found(numbered_rays, *chosen, "a = np.arctan2(y[n], x[n])") == []


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
    ((_, said),) = ROOM.of(map_starts)[0](ast.parse(SUBTRACTS.replace(old, new, 1) if old else SUBTRACTS))
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
    assert list(ROOM.of(map_starts)[0](ast.parse(text))) == []


@pytest.mark.parametrize(
    ("body", "number"),
    [
        ("if math.isinf(r):\n            continue\n        draw(angle, r)\n        angle += scan.angle_increment", 1),
        ("if r < 3.0:\n            draw(angle, r)\n            angle += scan.angle_increment", 1),
        ("angle += scan.angle_increment\n        if math.isinf(r):\n            continue\n        draw(angle, r)", 0),
        ("if r < 3.0:\n            draw(angle, r)\n        angle += scan.angle_increment", 0),
    ],
)
def test_an_angle_that_grows_only_with_some_rays(body, number):
    text = f"""
def on_scan(scan):
    angle = scan.angle_min
    for r in scan.ranges:
        {body}
"""
    assert len(list(numbered_rays.left_out_before_the_next_angle(ast.parse(text)))) == number


@pytest.mark.parametrize(
    ("angle", "found"),
    [
        ("scan.angle_max + i * scan.angle_increment", True),
        ("yaw + scan.angle_max + scan.angle_increment * i", True),
        ("scan.angle_max - i * scan.angle_increment", False),
        ("scan.angle_min + i * scan.angle_increment", False),
        ("scan.angle_max + k * scan.angle_increment", False),
    ],
)
def test_rays_that_are_counted_from_the_end(angle, found):
    text = f"def on_scan(scan, yaw, k):\n    for i, r in enumerate(scan.ranges):\n        use(r, {angle})\n"
    assert ["begins where the scan ends" in each["said"] for each in slips(text.encode())] == [True] * found


@pytest.mark.parametrize(
    ("code", "found"),
    [
        ("x, y = t.translation.x + r * math.sin(a), t.translation.y + r * math.cos(a)", True),
        ("point.x, point.y = r * sin(a), r * cos(a)", True),
        ("x, y = r * sin(a), r * cos(a); p.x, p.y = x, y", True),
        ("x, y = r * sin(a), r * cos(a)", False),
        ("x, y = t.translation.x + r * math.cos(a), t.translation.y + r * math.sin(a)", False),
        ("point.x, point.y = r * sin(b), r * cos(b)", False),
        ("point.x, point.y = c * r * cos(a) - s * r * sin(a), r * cos(a)", False),
    ],
)
def test_the_sine_of_a_ray_is_not_ahead(code, found):
    text = "def on_scan(scan, point, b, c, s, t):\n    for i, r in enumerate(scan.ranges):\n"
    text += f"        a = scan.angle_min + i * scan.angle_increment\n        {code}\n        use(point)\n"
    assert ["x, ahead, has its cosine" in each["said"] for each in slips(text.encode())] == [True] * found
