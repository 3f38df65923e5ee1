"""`compare`: against the last value of the reference, scaled, of angles, of too few."""

import math

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

MINE, TRUE = "topics/estimate/data", "truth/robot/x"
ASKED = {"signal": MINE, "reference": TRUE, "tolerance": 0.05, "name": "the estimate", "unit": "m"}


@pytest.mark.parametrize(("said", "passed"), [(1.0, True), (1.05, True), (0.95, True), (1.06, False), (0.0, False)])
def test_the_last_value_of_the_reference_counts(record, found, said, passed):
    finding = found("compare", record({TRUE: [(0, 0.0), (1, 1.0), (3, 9.0)], MINE: [(2, said)]}), **ASKED)
    assert finding.passed is passed
    assert finding.expected == "the estimate within 0.05 m of truth/robot/x"
    if not passed:
        assert finding.measured == f"0 of 1 values right; at 2.00 s it was {said:.2f} m, wanted was 1.00 m"


def test_a_share_is_enough(record, found):
    rows = [(1 + i * 0.1, 1.0 if i else 5.0) for i in range(20)]
    recording = record({TRUE: [(0, 1.0)], MINE: rows})
    assert found("compare", recording, **ASKED).passed
    assert not found("compare", recording, at_least=1.0, **ASKED).passed
    assert found("compare", recording, at_least=1.0, window=[1.05, 8.0], **ASKED).passed


def test_too_few_are_no_answer(record, found):
    recording = record({TRUE: [(0, 1.0)], MINE: [(1, 1.0)]})
    assert found("compare", recording, samples=2, **ASKED).measured == "1 values, at least 2 are needed"
    assert found("compare", record({TRUE: [(0, 1.0)]}), **ASKED).measured == "nothing was recorded on it"


@settings(deadline=None, max_examples=15, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.floats(-9, 9), st.floats(-3, 3), st.floats(-3, 3))
def test_factor_and_offset(record, found, true, factor, offset):
    wanted = factor * true + offset
    near, far = (record({TRUE: [(0, true)], MINE: [(1, wanted + off)]}) for off in (0.01, 0.1))
    assert found("compare", near, factor=factor, offset=offset, **ASKED).passed
    assert not found("compare", far, factor=factor, offset=offset, **ASKED).passed


@settings(deadline=None, max_examples=10, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.floats(-3, 3), st.integers(-3, 3))
def test_angles_may_differ_by_full_turns(record, found, angle, turns):
    recording = record({TRUE: [(0, angle)], MINE: [(1, angle + turns * 2 * math.pi)]})
    assert found("compare", recording, angle=True, **ASKED).passed
    assert found("compare", recording, **ASKED).passed == (turns == 0)
