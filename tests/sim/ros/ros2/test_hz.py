"""The arithmetic of `ros2 topic hz`."""

import pytest

from gz_course.sim.ros.ros2.command.topic.hz import Rate

MS = 1_000_000


def rate_of(*stamps, window=10000):
    """Return the report after messages at these times [ms]."""
    clock = iter(stamps)
    rate = Rate(lambda: next(clock) * MS, window)
    for _ in stamps:
        rate.tick()
    return rate


def test_rate_spread_and_window():
    assert rate_of(1000, 1100, 1300).report() == (
        "average rate: 6.667\n\tmin: 0.100s max: 0.200s std dev: 0.05000s window: 2"
    )


def test_only_the_window_counts():
    assert rate_of(0, 5000, 5100, 5200, window=2).report().startswith("average rate: 10.000\n")


@pytest.mark.parametrize("stamps", [(), (5,), (5, 5, 5), (5, 4)])
def test_nothing_to_report(stamps):
    assert rate_of(*stamps).report() == ""


def test_nothing_new_is_reported_twice():
    rate = rate_of(100, 200)
    assert rate.report()
    assert rate.report() == ""


def test_a_clock_that_jumps_back_begins_anew():
    assert rate_of(900, 1000, 100, 600).report().startswith("average rate: 2.000\n")


def test_the_time_before_the_first_clock_message_does_not_count():
    assert rate_of(0, 0, 7000, 7200, 7400).report().startswith("average rate: 5.000\n")


def test_a_clock_at_zero_begins_anew():
    assert rate_of(900, 1000, 0, 500, 900).report().startswith("average rate: 2.500\n")
