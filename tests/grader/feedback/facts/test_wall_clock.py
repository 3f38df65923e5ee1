"""Where a file asks the wall clock: however it was imported, and nowhere else."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.grader.feedback.facts.clocks import wall_clock


@pytest.mark.parametrize(
    ("text", "call", "waits"),
    [
        ("import time\ntime.time()", "time.time()", False),
        ("import time as t\nt.monotonic_ns()", "t.monotonic_ns()", False),
        ("from time import perf_counter as now\nnow()", "now()", False),
        ("from datetime import datetime\ndatetime.now()", "datetime.now()", False),
        ("import datetime\ndatetime.datetime.utcnow()", "datetime.datetime.utcnow()", False),
        ("import time\ntime.sleep(5)", "time.sleep()", True),
        ("from rclpy.clock import Clock\nClock()", "Clock()", False),
        ("import rclpy.clock\nrclpy.clock.Clock(clock_type=STEADY_TIME)", "rclpy.clock.Clock()", False),
    ],
)
def test_it_is_found_with_its_line(text, call, waits):
    assert wall_clock(text.encode()) == [{"line": 2, "call": call, "waits": waits}]


@pytest.mark.parametrize(
    "text",
    [
        "self.get_clock().now()",
        "time.time()",  # never imported: a name of the file's own
        "def sleep(): pass\nsleep()",
        "from rclpy.clock import Clock, ClockType\nClock(clock_type=ClockType.ROS_TIME)",
        "import time\ntime.strftime('x')\nlater = time.time",
        "from .time import time\ntime()",
        "def",
        "\x00",
    ],
)
def test_what_asks_no_wall_clock(text):
    assert wall_clock(text.encode()) == []


def test_places_come_in_order_and_are_not_too_many():
    lines = [place["line"] for place in wall_clock(b"import time\n" + b"time.time()\n" * 20)]
    assert lines == [2, 3, 4, 5, 6]


@given(st.binary(max_size=200))
def test_no_content_breaks_it(content):
    assert wall_clock(content) == []
