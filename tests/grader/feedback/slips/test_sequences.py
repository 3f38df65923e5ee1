"""Lists, generators, comparisons and logs: what is found in a callback, and what is right and stays unnamed."""

import pytest

from gz_course.grader.feedback.facts.logs import seldom_log, silent_log
from gz_course.grader.feedback.facts.whole_numbers import whole_numbers
from gz_course.grader.feedback.slips import slips

HEAD = """\
import logging
log = logging.getLogger('x')
class A(Node):
    def start(self):
        self.create_subscription(S, '/s', self.on_scan, 10)
    def on_scan(self, scan):
"""


def callback(*lines):
    return (HEAD + "\n".join(f"        {line}" for line in lines) + "\n").encode()


FAULTY = [
    (["valid = (r for r in scan.ranges)", "n = len(list(valid))", "least = min(valid)"], "can be read only once"),
    (
        ["valid = filter(None, scan.ranges)", "a = sum(valid)", "for r in valid:", "    print(r)"],
        "what filter() returns",
    ),
    (
        ["rays = list(scan.ranges)", "for r in rays:", "    if r > 9:", "        rays.remove(r)"],
        "skips the next element",
    ),
    (["a = [1]", "for i, r in enumerate(a):", "    del a[i]"], "skips the next element"),
    (["if scan.ranges[0] != float('nan'):", "    pass"], "nothing is equal to nan"),
    (["if scan.ranges[0] is not math.inf:", "    pass"], "asks for the same object"),
    (["self.get_logger().info('%d rays', 3)"], "takes one text"),
    (["time.sleep(0.5)"], "while it sleeps"),
    (["if any(math.isinf(r) for r in scan.ranges):", "    return"], "leave out the ray"),
    (["if math.inf in scan.ranges:", "    return"], "leave out the ray"),
    (["v = [r for r in scan.ranges]", "for r in v:", "    self.pub.publish(r)"], "belongs after the loop"),
    (["def add(x, a=[]):", "    a.append(x)"], "stays in it from call to call"),
    (["least = 0.0", "for r in scan.ranges:", "    if r < least:", "        least = r"], "least begins at 0"),
    (["least = 0", "for r in scan.ranges:", "    if 0.1 < r and least > r:", "        least = r"], "it stays 0"),
    (["least = 0.0", "for r in scan.ranges:", "    least = min(least, r)"], "begins at math.inf"),
    (["most = 1000", "for r in scan.ranges:", "    if r > most:", "        most = r"], "no distance is larger"),
    (["v = [i for i in range(len(scan.ranges)) if scan.range_min < i]"], "ranges[i]"),
    (
        ["for i, r in enumerate(scan.ranges):", "    if i < scan.range_max:", "        print(r)"],
        "is the number of a ray",
    ),
]
RIGHT = [
    ["valid = [r for r in scan.ranges]", "n = len(valid)", "least = min(valid)"],
    ["valid = (r for r in scan.ranges)", "least = min(valid)"],
    ["valid = filter(None, scan.ranges)", "valid = list(valid)", "a = sum(valid) / len(valid)"],
    ["rays = [1]", "for r in rays:", "    if r:", "        rays.remove(r)", "        break"],
    ["for scan in list(self.waiting):", "    self.waiting.remove(scan)"],
    ["if scan.ranges[0] == math.inf:", "    pass"],
    ["least = 100.0", "for r in scan.ranges:", "    if r < least:", "        least = r"],
    ["time.sleep(0.01)"],
    ["if not scan.ranges:", "    return"],
    ["if any(r < 0.2 for r in scan.ranges):", "    self.near = True"],
    ["for scan in self.waiting:", "    self.pub.publish(scan)"],
    ["for r in scan.ranges:", "    if r < 1.0:", "        self.pub.publish(r)", "        break"],
    ["def add(x, a=None):", "    a.append(x)"],
    ["n = 0", "for r in scan.ranges:", "    if scan.range_min < r:", "        n += 1"],
    ["total = 0.0", "for r in scan.ranges:", "    total = total + r"],
    ["v = [r for i, r in enumerate(scan.ranges) if scan.range_min < r]"],
    ["self.get_logger().info('text', throttle_duration_sec=1.0)"],
]


@pytest.mark.parametrize(("lines", "words"), FAULTY)
def test_a_slip_is_named(lines, words):
    assert any(words in place["said"] for place in slips(callback(*lines)))


@pytest.mark.parametrize("lines", RIGHT)
def test_what_is_right_has_no_slip(lines):
    lines = lines if any("get_logger" in line for line in lines) else [*lines, "self.get_logger().info('x')"]
    assert slips(callback(*lines)) == []


@pytest.mark.parametrize(
    ("lines", "found"),
    [
        (["a = np.array(scan.ranges)", "self.pub.publish(Float32(data=a.min()))"], ["a.min()"]),
        (["a = np.asarray(scan.ranges)", "b = a[a < 5]", "m = np.min(b)", "msg.data = m"], ["m"]),
        (["msg.point.x = np.float32(2.0)"], ["np.float32(2.0)"]),
        (["a = np.array(scan.ranges)", "msg.data = round(a.min(), 2)"], ["round(a.min(), 2)"]),
        (["a = np.array(scan.ranges)", "msg.data = float(a.min())"], []),
        (["a = np.array(scan.ranges, dtype=float)", "msg.data = a.min()"], []),
        (["a = np.array(list(scan.ranges))", "msg.data = a.min()"], []),
        (["a = np.array(scan.ranges)", "msg.data = a.min().item()"], []),
        (["a = np.array(scan.ranges)", "self.x = a.min()", "i = a.argmin()"], []),
        (["a = np.array(scan.ranges).astype(np.float64)", "msg.data = a.min()"], []),
    ],
)
def test_numbers_of_float32_in_messages_are_found(lines, found):
    assert [place["value"] for place in whole_numbers(callback(*lines), {"Float32": {"data"}})] == found


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        (["log.info('text')"], "Python's own log"),
        (["self.get_logger().debug('text')"], "silent at a logger's usual level"),
        (["self.get_logger().debug('text')", "self.get_logger().info('text')"], ""),
        (["pass"], ""),
    ],
)
def test_a_log_that_nobody_gets_is_found(lines, words):
    found = silent_log(callback(*lines))
    assert bool(found) == bool(words) and all(words in place["said"] for place in found)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ("throttle_duration_sec=1.0", "throttle_duration_sec=1.0 lets this line through once in 1.0 s only"),
        ("once=True", "once only"),
        ("skip_first=True", "leaves out the first line"),
        ("once=False", ""),
        ("name='scan'", ""),
    ],
)
def test_an_option_of_a_log_that_leaves_lines_out_is_found(options, words):
    found = seldom_log(callback(f"self.get_logger().info('text', {options})"))
    assert bool(found) == bool(words) and all(words in place["said"] for place in found)
