"""A counter that is compared above the line that increases it, and a publish() before the node waits."""

import pytest

from gz_course.grader.feedback.facts.publishing import counters, early_publishing

COUNTS = """\
class Greeter:
    def __init__(self):
        self.calls = 0

    def tick(self):
        if self.calls == 1:
            self.publisher.publish(text)
        self.calls += 1
"""


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("self.calls", "self.calls"),
        ("self.calls += 1", "self.calls = self.calls + 1"),
        ("== 1", ">= 2 - 1"),
        ("== 1", "== round(1.1 / 1)"),
        ("== 1", "== int(1.9)"),
    ],
)
def test_a_comparison_above_the_increase_is_a_place(old, new):
    (place,) = counters(COUNTS.replace(old, new).encode())
    assert (place["line"], place["counter"], place["limit"]) == (6, "self.calls", 1.0)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("self.calls = 0", "self.calls = 1"),
        ("self.calls += 1", "self.calls += 2"),
        ("self.calls == 1", "self.other == 1"),
        ("        if self.calls", "        self.calls += 1\n        if self.calls"),
    ],
)
def test_what_is_no_such_counter_is_none(old, new):
    above = "+= 1" in new
    text = COUNTS.replace(old, new)
    assert counters((text.removesuffix("        self.calls += 1\n") if above else text).encode()) == []


MAKES = """\
class Greeter(Node):
    def __init__(self):
        super().__init__("greeter")
        self.publisher = self.create_publisher(String, "/hello", 10)
        {line}

    def greet(self):
        self.publisher.publish(String())


def main():
    rclpy.init()
    rclpy.spin(Greeter())
"""


@pytest.mark.parametrize("line", ["self.publisher.publish(String())", "self.greet()"])
def test_what_init_publishes_is_early(line):
    assert early_publishing(MAKES.format(line=line).encode()) == [{"line": 5, "function": "__init__"}]


@pytest.mark.parametrize(
    "line", ["self.create_timer(1.0, self.greet)", "self.later = lambda: self.publisher.publish(1)"]
)
def test_what_a_callback_publishes_is_not(line):
    assert early_publishing(MAKES.format(line=line).encode()) == []


def test_main_publishes_early_until_it_waits():
    early = "def main():\n    rclpy.init()\n    p.publish(1)\n    time.sleep(1.0)\n    p.publish(1)\n"
    assert early_publishing(early.encode()) == [{"line": 3, "function": "main"}]
    assert early_publishing(early.replace("    p.publish(1)\n    time", "    time").encode()) == []
