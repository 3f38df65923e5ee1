"""Sums of floats, ranks for rays, and two clocks in one difference: named if the file proves them, and only then."""

import pytest

from gz_course.grader.feedback.slips import slips

WRONG = {
    # exact_sums.py
    "self.t is never exactly 1: adding 0.1 again and again gives 0.9999999999999999": (
        "self.t = 0.0", "self.t += 0.1", "if self.t == 1.0:"
    ),
    "compare with <=, or count": ("self.left = 1.0", "self.left = self.left - 0.1", "if self.left == 0:"),
    "self.n * 0.1 is never exactly 0.3: it is 0.2, then 0.30000000000000004": (
        "self.n = 0", "self.n += 1", "if self.n * 0.1 == 0.3:"
    ),
    "self.t is not exactly 1: adding 0.1 again and again": ("self.t = 0", "self.t += 0.1", "if self.t % 1.0 == 0:"),
    "adding 0.3 again and again gives 0.8999999999999999, then 1.2": ("t = 0", "t += 0.3", "while t != 1:"),
    # time_units.py
    "always less than 1e9": ("now = self.get_clock().now().to_msg()", "if now.nanosec >= 1e9:", "    go()"),
    "is a Time and never equal to a number": ("now = self.get_clock().now()", "if now == 1.0:", "    go()"),
    # sorted_rays.py
    "i is a place in sorted ranges": (
        "for i, r in enumerate(sorted(scan.ranges)):", "    a = i * scan.angle_increment"
    ),
    "k is a place in sorted ranges": (
        "near = sorted(scan.ranges)", "k = near.index(min(near))", "a = scan.angle_min + scan.angle_increment * k"
    ),
    "n is a place in sorted ranges": (
        "ranges = list(scan.ranges)", "ranges.sort()", "n = np.argmin(ranges)", "a = n * scan.angle_increment"
    ),
    "i is a place in filtered ranges (good.index(min(good)))": (
        "good = [r for r in scan.ranges if r < 9]", "i = good.index(min(good))", "a = i * scan.angle_increment"
    ),
    "i is a place in filtered ranges (np.argmin": (
        "ranges = np.array(scan.ranges)", "i = np.argmin(ranges[np.isfinite(ranges)])", "a = i * scan.angle_increment"
    ),
    "j is a place in filtered ranges": (
        "for r in scan.ranges:", "    if r < 9:", "        good.append(r)", "j = good.index(min(good))",
        "a = scan.angle_min + j * scan.angle_increment"
    ),
    "i is a place in reversed ranges": ("x = [i * scan.angle_increment for i, r in enumerate(scan.ranges[::-1])]",),
    # mixed_clocks.py
    "time.time() is the time of the computer": ("age = time.time() - message.header.stamp.sec",),
    "time.monotonic() is the time of the computer": (
        "stamp = self.last.header.stamp", "now = time.monotonic()", "late = now - (stamp.sec + stamp.nanosec / 1e9)"
    ),
}  # fmt: skip
HARMLESS = [
    ("self.t = 0.0", "self.t += 0.25", "if self.t == 1.0:"),
    ("self.n = 0", "self.n += 1", "if self.n == 10:"),
    ("self.t = 0.0", "self.t += 0.1", "self.t = other", "if self.t == 1.0:"),
    ("self.t = 0.0", "self.t += 0.1", "if self.t >= 1.0:"),
    ("t = 0.0", "t += 0.1", "if t == -1.0:"),
    ("for i, r in enumerate(sorted(scan.ranges)):", "    print(i, r)"),
    ("pairs = sorted((r, i) for i, r in enumerate(scan.ranges))", "a = pairs[0][1] * scan.angle_increment"),
    ("near = sorted(scan.ranges)", "i = scan.ranges.index(near[0])", "a = i * scan.angle_increment"),
    ("good = [r if r < 9 else 9.0 for r in scan.ranges]", "i = good.index(min(good))", "a = i * scan.angle_increment"),
    ("good = [(r, i) for i, r in enumerate(scan.ranges) if r]", "r, i = min(good)", "a = i * scan.angle_increment"),
    ("self.n = 0", "self.n += 1", "if self.n * 0.1 == 0.5:"),
    ("self.n = 0", "self.n += 1", "if self.n % 10 == 0:"),
    ("order = np.argsort(scan.ranges)", "i = order[0]", "a = i * scan.angle_increment"),
    ("begin = time.time()", "took = time.time() - begin"),
    ("now = self.get_clock().now().to_msg()", "age = now.sec - message.header.stamp.sec"),
]


def found(lines):
    body = "".join(f"        {line}\n" for line in lines)
    last = f"{' ' * (12 if lines[-1].endswith(':') else 8)}self.work()\n"
    text = f"import time\n\nimport numpy as np\n\n\nclass A:\n    def on_scan(self, scan, message):\n{body}{last}"
    return slips(text.encode(), 10.0)


@pytest.mark.parametrize("words", WRONG)
def test_each_is_named_with_its_line(words):
    places = found(WRONG[words])
    assert [place for place in places if words in place["said"] and place["line"] >= 8], places


@pytest.mark.parametrize("lines", HARMLESS, ids=str)
def test_what_is_right_is_not_named(lines):
    assert found(lines) == []
