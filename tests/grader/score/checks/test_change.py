"""`change`: both verdicts, both bounds, windows."""

import pytest

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.score.checks.change import change as kind


def change(recording, parameters):
    return kind(recording, Table(parameters, "check 'it'", "parameter"))


YAW = "truth/robot/yaw"
PARAMETERS = {"signal": YAW, "band": [0.1, 1.8], "unit": "rad", "name": "heading"}


@pytest.mark.parametrize(
    ("last", "passed"), [(0.5, True), (0.1, True), (1.8, True), (0.0999, False), (1.8001, False), (-0.5, False)]
)
def test_the_change_must_lie_in_the_band(record, last, passed):
    finding = change(record({YAW: [(0, 0.0), (8, last)]}), PARAMETERS)
    assert finding.passed is passed
    assert finding.expected == "heading changes by 0.1 to 1.8 rad"
    assert finding.measured == f"changed by {last:.2f} rad"


def test_it_is_the_change_that_counts_not_the_value(record):
    assert change(record({YAW: [(0, 100.0), (8, 100.5)]}), PARAMETERS).passed
    assert not change(record({YAW: [(0, 0.5), (8, 0.5)]}), PARAMETERS).passed


def test_the_first_sample_stands_for_the_time_before_it(record):
    assert change(record({YAW: [(0.01, 3.0), (8, 3.5)]}), PARAMETERS).measured == "changed by 0.50 rad"


def test_only_the_window_counts(record):
    recording = record({YAW: [(0, 0.0), (2, 0.5), (6, 5.0)]})
    assert change(recording, PARAMETERS | {"window": [1.0, 4.0]}).passed
    assert not change(recording, PARAMETERS).passed


def test_what_comes_after_the_window_is_no_change_in_it(record):
    finding = change(record({YAW: [(5, 1.0), (6, 1.5)]}), PARAMETERS | {"window": [1.0, 4.0]})
    assert (finding.passed, finding.measured) == (False, "nothing was recorded on it")


def test_a_signal_nobody_recorded_fails_even_when_no_change_is_asked_for(record):
    finding = change(record(), PARAMETERS | {"band": [-1, 1]})
    assert (finding.passed, finding.measured) == (False, "nothing was recorded on it")


def test_a_change_of_nothing_is_not_called_minus_nothing(record):
    assert change(record({YAW: [(0, 0.0), (8, -1e-9)]}), PARAMETERS).measured == "changed by 0.00 rad"
