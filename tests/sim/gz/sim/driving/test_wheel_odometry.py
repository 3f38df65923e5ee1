"""Odometry from wheel angles against the closed form of a circle."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.gz.sim.driving.wheel_odometry import WheelOdometry


@given(st.floats(-2, 2), st.floats(-3, 3), st.integers(1, 200))
def test_any_constant_motion_ends_on_its_circle(speed: float, turn: float, steps: int) -> None:
    odometry = WheelOdometry(0.4, 0.1)
    for step in range(1, steps + 1):
        t = step * 0.01
        odometry.update((speed - turn * 0.2) * t / 0.1, (speed + turn * 0.2) * t / 0.1, 0.01)
    t = steps * 0.01
    if abs(turn) > 1e-3:
        x, y = speed / turn * math.sin(turn * t), speed / turn * (1 - math.cos(turn * t))
        assert (odometry.x, odometry.y) == pytest.approx((x, y), abs=1e-6)
    assert odometry.heading == pytest.approx(turn * t, abs=1e-9)
    assert odometry.linear == pytest.approx(speed, abs=1e-9)
    assert odometry.angular == pytest.approx(turn, abs=1e-9)


def test_speeds_are_means_of_the_last_ten_steps() -> None:
    odometry = WheelOdometry(1.0, 1.0)
    for _ in range(20):
        odometry.update(0.0, 0.0, 0.01)
    odometry.update(0.01, 0.01, 0.01)
    assert odometry.linear == pytest.approx(0.1)
