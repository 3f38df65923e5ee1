"""Limits of velocity, acceleration and jerk."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.gz.sim.driving.speed_limiter import SpeedLimiter
from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.sdf.element import parse


@given(st.lists(st.floats(-10, 10), min_size=1, max_size=60))
def test_no_limit_is_ever_exceeded(targets: list[float]) -> None:
    limiter = SpeedLimiter(-1.0, 2.0, -3.0, 4.0)
    speed = before = 0.0
    for target in targets:
        new = limiter.limit(target, speed, before, 0.01)
        assert -1.0 <= new <= 2.0
        assert -3.0 - 1e-9 <= (new - speed) / 0.01 <= 4.0 + 1e-9
        speed, before = new, speed


@given(st.floats(-100, 100), st.floats(-100, 100), st.floats(-100, 100))
def test_without_limits_nothing_changes(target: float, previous: float, before: float) -> None:
    assert SpeedLimiter().limit(target, previous, before, 0.001) == target


def test_jerk_bends_the_start() -> None:
    limiter = SpeedLimiter(min_jerk=-1.0, max_jerk=1.0)
    first = limiter.limit(10.0, 0.0, 0.0, 0.1)
    second = limiter.limit(10.0, first, 0.0, 0.1)
    assert (first, second) == pytest.approx((0.01, 0.03))


def test_axis_limits_win_over_common_ones_and_crossed_limits_are_refused() -> None:
    element = parse("<p><max_velocity>1</max_velocity><max_linear_velocity>2</max_linear_velocity></p>")
    assert SpeedLimiter.from_sdf(element, "linear").max_velocity == 2.0
    assert SpeedLimiter.from_sdf(element, "angular").max_velocity == 1.0
    with pytest.raises(SdfError, match="is above"):
        SpeedLimiter.from_sdf(parse("<p><max_velocity>-1</max_velocity><min_velocity>0</min_velocity></p>"), "linear")
