"""PID: terms, limits and invalid values."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.gz.sim.driving.pid import PID
from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.sdf.element import parse

errors = st.lists(st.floats(-100, 100), min_size=1, max_size=50)


def test_terms_add_up_with_the_opposite_sign() -> None:
    pid = PID(2.0, 3.0, 0.5, 10.0, -10.0, 100.0, -100.0, 7.0)
    assert pid.update(1.0, 0.1) == pytest.approx(7.0 - 2.0 - 0.3 - 0.5 * 10.0)
    assert pid.update(1.0, 0.1) == pytest.approx(7.0 - 2.0 - 0.6)
    pid.reset()
    assert pid.update(1.0, 0.1) == pytest.approx(7.0 - 2.0 - 0.3 - 5.0)


@given(errors)
def test_limits_hold(values: list[float]) -> None:
    pid = PID(5.0, 50.0, 0.1, 2.0, -1.0, 30.0, -20.0, 0.0)
    for error in values:
        assert -20.0 <= pid.update(error, 0.01) <= 30.0
        assert -1.0 <= pid.integral <= 2.0


@given(errors)
def test_crossed_limits_are_no_limits(values: list[float]) -> None:
    pid = PID(0.0, 10.0, 0.0, -1.0, 0.0, -1.0, 0.0, 0.0)
    for error in values:
        command = pid.update(error, 0.1)
    assert command == pytest.approx(-sum(values), abs=1e-9)


@pytest.mark.parametrize("error", [math.nan, math.inf, -math.inf])
def test_errors_that_are_not_finite_push_with_nothing_and_leave_no_trace(error: float) -> None:
    pid = PID(1.0, 1.0, 1.0, 10.0, -10.0, 100.0, -100.0, 5.0)
    assert pid.update(error, 0.1) == 0.0
    assert (pid.integral, pid.last_error) == (0.0, 0.0)


def test_parameters_and_their_faults() -> None:
    element = parse("<p><p_gain>9</p_gain><cmd_max>inf</cmd_max></p>")
    pid = PID.from_sdf(element, 1.0, 0.1, 0.01, 1.0, -1.0, 1000.0, -1000.0, 0.0)
    assert (pid.p_gain, pid.i_gain, pid.cmd_max) == (9.0, 0.1, math.inf)
    with pytest.raises(SdfError, match="<p_gain> must be finite"):
        PID.from_sdf(parse("<p><p_gain>inf</p_gain></p>"), *[0.0] * 8)
