"""`time_in_band`: both verdicts, both bounds, and what is said."""

import pytest

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.score.checks.time_in_band import time_in_band as kind


def time_in_band(recording, parameters):
    return kind(recording, Table(parameters, "check 'it'", "parameter"))


SPEED = "truth/robot/linear_x"
PARAMETERS = {
    "conditions": [{"signal": SPEED, "low": 0.45, "high": 0.55, "name": "forward speed", "unit": "m/s"}],
    "seconds": [4.7, 5.4],
}


def driving(seconds):
    return {SPEED: [(0, 0.0), (1, 0.5), (1 + seconds, 0.0)]}


@pytest.mark.parametrize(
    ("seconds", "passed"), [(5.0, True), (4.7, True), (5.4, True), (4.699, False), (5.401, False), (0.001, False)]
)
def test_the_time_must_lie_between_both_bounds(record, seconds, passed):
    finding = time_in_band(record(driving(seconds)), PARAMETERS)
    assert finding.passed is passed
    assert finding.measured.startswith(f"in band for {seconds:.2f} s")
    assert finding.expected == "forward speed between 0.45 and 0.55 m/s for 4.7 to 5.4 s"
    assert finding.at_s == pytest.approx(1 + seconds)


def test_the_band_may_be_left_and_entered_again(record):
    rows = [(0, 0.5), (2, 0.0), (4, 0.5), (7, 0.56)]
    assert time_in_band(record({SPEED: rows}), PARAMETERS).passed


def test_without_an_upper_bound_longer_is_fine(record):
    finding = time_in_band(record({SPEED: [(0, 0.5)]}), PARAMETERS | {"seconds": [4.7]})
    assert (finding.passed, finding.expected.split(" for ")[1]) == (True, "at least 4.7 s")


def test_only_the_window_counts(record):
    recording = record({SPEED: [(0, 0.5)]})
    assert time_in_band(recording, PARAMETERS | {"seconds": [2.0, 2.0], "window": [3, 5]}).passed


def test_all_conditions_must_hold_at_once(record):
    turning = {"signal": "truth/robot/angular_z", "low": 0.05}
    both = PARAMETERS | {"conditions": [*PARAMETERS["conditions"], turning], "seconds": [2.0, 2.0]}
    assert time_in_band(record(driving(4) | {"truth/robot/angular_z": [(0, 0.0), (3, 0.1)]}), both).passed


def test_a_failure_says_what_the_signal_usually_was(record):
    finding = time_in_band(record({SPEED: [(0, 0.0), (1, 0.2), (2, 0.2), (3, 0.2), (4, 0.0)]}), PARAMETERS)
    assert finding.measured == "in band for 0.00 s; forward speed was mostly 0.20 m/s"
    finding = time_in_band(record({SPEED: [(0, 0.0)]}), PARAMETERS)
    assert finding.measured == "in band for 0.00 s; forward speed was always 0"


def test_a_signal_nobody_recorded_fails(record):
    finding = time_in_band(record(), PARAMETERS | {"seconds": [0.0]})
    assert (finding.passed, finding.measured, finding.at_s) == (False, "nothing was recorded on it", None)


def test_one_missing_signal_of_two_fails(record):
    two = PARAMETERS | {"conditions": [*PARAMETERS["conditions"], {"signal": "truth/robot/none", "low": 0}]}
    finding = time_in_band(record(driving(5)), two)
    assert not finding.passed
    assert "truth/robot/none was never seen" in finding.measured


def test_its_bands_are_told_for_the_recording(record):
    (band,) = time_in_band(record(driving(5)), PARAMETERS).bands
    assert (band.signal, band.low, band.high, band.start, band.end) == (SPEED, 0.45, 0.55, 0.0, 8.0)


def test_a_run_that_ended_early_earns_no_time_after_its_end(record):
    """No evidence is no pass: what the robot did after the recording's end nobody knows."""
    recording = record({SPEED: [(0, 0.5), (1, 0.5)]}, facts={"sim_seconds": 1.0})
    assert not time_in_band(recording, PARAMETERS | {"seconds": [4.7]}).passed


def test_right_values_that_lasted_no_time_are_a_matter_of_time(record):
    blink = time_in_band(record({SPEED: [(0, 0.5), (0, 0.0)]}), PARAMETERS)
    assert (blink.passed, blink.timing, blink.measured[:20]) == (False, True, "in band for 0.00 s; ")
    assert not time_in_band(record({SPEED: [(0, 5.0), (1, 0.0)]}), PARAMETERS).timing


def test_the_usual_value_is_measured_over_what_was_sent(record, found):
    sent = [(0.1, 0.5), *((0.1 * n, 0.0) for n in range(2, 82))]
    finding = found(
        "time_in_band", record({"v": sent}), conditions=[{"signal": "v", "low": 0.45, "name": "it"}], seconds=[4.7]
    )
    assert finding.measured.endswith("it was 0.50 in 1 of 81 values and 0 in the others")
