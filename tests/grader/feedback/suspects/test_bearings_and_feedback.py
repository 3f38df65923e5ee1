"""What a wall follower may get wrong in the bearings of rays and in what it feeds back; and what is right."""

import pytest

from gz_course.grader.feedback.suspects import suspects

WRONG = {
    # bearings.py
    "i * scan.angle_increment counts from ray 0": (
        "for i, r in enumerate(scan.ranges):", "    b = i * scan.angle_increment"
    ),
    "i * step counts from ray 0": (
        "step = scan.angle_increment", "rays = [(r, i * step) for i, r in enumerate(scan.ranges) if r < 9]"
    ),
    "1.57 / scan.angle_increment counts from ray 0": ("left = scan.ranges[int(1.57 / scan.angle_increment)]",),
    "i * math.pi / 180 takes the number of a ray for its bearing": (
        "for i, r in enumerate(scan.ranges):", "    b = i * math.pi / 180"
    ),
    "math.radians(i) takes the number of a ray for its bearing": (
        "for i in range(len(scan.ranges)):", "    b = math.radians(i)"
    ),
    "the 90 of ABEAM are degrees, and b is in radians": (
        "ABEAM = 90.0", "b = scan.angle_min", "b += scan.angle_increment", "away = b - ABEAM"
    ),
    "30 are degrees, and abs(b) is in radians": ("b = scan.angle_min + i * scan.angle_increment", "near = abs(b) < 30"),
    # feedback.py
    "mean(side) depends on all": (
        "side = [r for r in scan.ranges if r < 9]", "d = statistics.mean(side)", "command.angular.z = d"
    ),
    "sum(found) / len(found) depends on all": (
        "for i, r in enumerate(scan.ranges):", "    found.append(r)", "command.angular.z = sum(found) / len(found)"
    ),
    "self.turn += 2.0 * error adds the correction": ("self.turn += 2.0 * error", "command.angular.z = self.turn"),
    "self.out.angular.z + error adds the correction": (
        "turn = self.out.angular.z + error", "self.out.angular.z = max(-1.5, turn)"
    ),
    "is an integral that nothing limits": ("self.total += d * 0.1", "command.angular.z = d + self.total"),
    "left to drive is the difference, self.wall.range - self.stop_at": (
        "self.stop_at = self.declare_parameter('stop_at', 1.0).value", "left = self.wall.range + self.stop_at"
    ),
    "left to drive is the difference, near - wanted": (
        "near, wanted = min(scan.ranges), self.get_parameter('distance').value", "way = wanted + near"
    ),
    "keeps a Parameter, which is a copy": ("self.distance = self.get_parameter('distance')",),
}  # fmt: skip
HARMLESS = [
    ("for i, r in enumerate(scan.ranges):", "    b = math.radians(i) - math.pi"),
    ("for i, r in enumerate(scan.ranges):", "    b = scan.angle_min + i * scan.angle_increment"),
    ("for i, r in enumerate(scan.ranges):", "    b = i * scan.angle_increment - math.pi"),
    ("for i, r in enumerate(scan.ranges):", "    b = i * scan.angle_increment", "    b -= math.pi"),
    ("left = scan.ranges[int((1.57 + math.pi) / scan.angle_increment)]",),
    ("left = scan.ranges[len(scan.ranges) // 2 + int(1.57 / scan.angle_increment)]",),
    ("b = math.degrees(scan.angle_min + i * scan.angle_increment)", "near = abs(b) < 30"),
    ("i = int((1.57 - scan.angle_min) / scan.angle_increment)", "near = i < 90"),
    ("near = [b for r, b in rays if r < 1]", "command.angular.z = sum(near) / len(near)"),
    ("side = [r for r in scan.ranges if r < 9]", "d = statistics.mean(side)"),
    ("self.turn += 0.3 * (wanted - self.turn)", "command.angular.z = self.turn"),
    ("self.total += d", "self.total = max(-1.0, min(1.0, self.total))", "command.angular.z = d + self.total"),
    ("self.distance = self.get_parameter('distance').value",),
]


def found(lines):
    body = "".join(f"        {line}\n" for line in lines)
    last = f"{' ' * (12 if lines[-1].endswith(':') else 8)}self.work()\n"
    return suspects(f"class A:\n    def __init__(self, scan, d, error, i):\n{body}{last}".encode())


@pytest.mark.parametrize("words", WRONG)
def test_each_is_found(words):
    places = found(WRONG[words])
    assert [place for place in places if words in place["said"] and place["line"] >= 3], places


@pytest.mark.parametrize("lines", HARMLESS, ids=str)
def test_what_is_right_is_not_suspected(lines):
    assert found(lines) == []
