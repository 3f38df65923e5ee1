"""The arithmetic of `ros2 topic bw` and `ros2 topic delay`."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from std_msgs.msg import Header

from gz_course.sim.ros.ros2.command.topic.bw import Bandwidth
from gz_course.sim.ros.ros2.command.topic.delay import Delay
from gz_course.sim.ros.ros2.measurement import spread

MS = 1_000_000


def bandwidth_of(*messages, now, window=100):
    """Return the report at `now` after (ms, bytes) messages."""
    clock = iter([*(stamp for stamp, _ in messages), now])
    bandwidth = Bandwidth(lambda: next(clock) * MS, window)
    for _, size in messages:
        bandwidth.arrived(bytes(size))
    return bandwidth.report()


@pytest.mark.parametrize(
    ("sizes", "report"),
    [
        ((10, 30), "40 B/s from 2 messages\n\tMessage size mean: 20 B min: 10 B max: 30 B"),
        ((500, 1500), "2.00 KB/s from 2 messages\n\tMessage size mean: 1.00 KB min: 0.50 KB max: 1.50 KB"),
        ((10**6,) * 2, "2.00 MB/s from 2 messages\n\tMessage size mean: 1.00 MB min: 1.00 MB max: 1.00 MB"),
    ],
)
def test_all_figures_are_in_the_unit_of_the_rate(sizes, report):
    assert bandwidth_of((0, sizes[0]), (500, sizes[1]), now=1000) == report


def test_only_the_window_counts_and_one_message_is_no_rate():
    assert bandwidth_of((0, 9000), (1000, 10), (1500, 10), now=2000, window=2).startswith("20 B/s from 2 messages")
    assert bandwidth_of((0, 10), now=1000) == ""


def test_a_clock_that_jumps_back_begins_a_new_bandwidth():
    assert bandwidth_of((5000, 10), (6000, 10), now=1000) == ""


def delays_of(*messages, window=100):
    """Return the reports after each of the (clock, stamp) messages [ms]."""
    clock = iter([now for now, _ in messages])
    delay = Delay(lambda: next(clock) * MS, window)
    for _, stamp in messages:
        header = Header()
        header.stamp.sec, header.stamp.nanosec = divmod(stamp * MS, 10**9)
        delay.arrived(type("Stamped", (), {"header": header}))
        yield delay.report()


def test_delay_is_the_age_of_the_stamps():
    *_, report = delays_of((1100, 1000), (2300, 2000))
    assert report == "average delay: 0.200\n\tmin: 0.100s max: 0.300s std dev: 0.10000s window: 2"


def test_delay_begins_with_the_clock_and_anew_when_it_jumps_back():
    first, second, third = delays_of((0, 0), (2000, 1000), (500, 250))
    assert first == ""
    assert second.startswith("average delay: 1.000")
    assert third.startswith("average delay: 0.250")


def test_delay_says_when_nothing_new_has_come():
    delay = Delay(lambda: MS, 10)
    assert delay.report() == ""
    delay.arrived(type("Stamped", (), {"header": Header()}))
    assert delay.report().startswith("average delay: 0.001")
    assert delay.report() == "no new messages"


@given(st.lists(st.floats(0, 1000), min_size=1, max_size=50))
def test_spread_is_between_its_ends(values):
    line = spread(values)
    least, most, deviation, window = (float(part.split(":")[1].split("s")[0]) for part in _parts(line))
    assert least <= most
    assert deviation <= (most - least) / 2 + 0.002
    assert window == len(values)


def _parts(line):
    words = line.strip().replace("std dev", "std_dev").split(" ")
    return [f"{name}{value}" for name, value in zip(words[::2], words[1::2], strict=True)]
