"""`stays_in_band`: both verdicts, the moment of the break, and what is said about the last command."""

import pytest

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.score.checks.stays_in_band import stays_in_band as kind


def stays_in_band(recording, parameters):
    return kind(recording, Table(parameters, "check 'it'", "parameter"))


SPEED, COMMAND = "truth/robot/linear_x", "topics/cmd_vel/linear/x"
PARAMETERS = {
    "conditions": [{"signal": SPEED, "low": -0.02, "high": 0.02, "name": "forward speed", "unit": "m/s"}],
    "last": 1.5,
    "command": COMMAND,
}


@pytest.mark.parametrize(("stop", "passed"), [(5.0, True), (6.5, True), (6.501, False), (7.9, False)])
def test_it_must_hold_from_the_beginning_of_the_last_seconds(record, stop, passed):
    finding = stays_in_band(record({SPEED: [(0, 0.5), (stop, 0.0)]}), PARAMETERS)
    assert finding.passed is passed
    assert finding.expected == "forward speed between -0.02 and 0.02 m/s from 6.5 s to the end at 8 s"


@pytest.mark.parametrize(("value", "passed"), [(0.02, True), (-0.02, True), (0.0201, False), (-0.0201, False)])
def test_the_bounds_belong_to_the_band(record, value, passed):
    assert stays_in_band(record({SPEED: [(0, value)]}), PARAMETERS).passed is passed


def test_a_break_of_one_tick_is_found_with_its_moment(record):
    finding = stays_in_band(record({SPEED: [(0, 0.0), (7.2, 0.3), (7.21, 0.0)]}), PARAMETERS)
    assert (finding.passed, finding.at_s) == (False, 7.2)
    assert finding.measured == "forward speed was 0.30 m/s at 7.20 s"


def test_a_signal_nobody_recorded_fails(record):
    finding = stays_in_band(record(), PARAMETERS)
    assert not finding.passed
    assert finding.measured == "forward speed had no value at 6.50 s"


def test_it_tells_commands_that_never_ceased_from_a_missing_stop(record):
    running = {SPEED: [(0, 0.5)]}
    still = stays_in_band(record(running | {COMMAND: [(t / 10, 0.5) for t in range(80)]}), PARAMETERS)
    assert still.measured.endswith("; commands of 0.50 were still coming at 7.90 s")
    ceased = stays_in_band(record(running | {COMMAND: [(t / 10, 0.5) for t in range(50)]}), PARAMETERS)
    assert ceased.measured.endswith("; the last command came at 4.90 s and was 0.50")


def test_every_condition_counts(record):
    turning = {"signal": "truth/robot/angular_z", "low": -0.05, "high": 0.05, "name": "turning rate", "unit": "rad/s"}
    both = PARAMETERS | {"conditions": [*PARAMETERS["conditions"], turning]}
    finding = stays_in_band(record({SPEED: [(0, 0.0)], "truth/robot/angular_z": [(0, 0.0), (7, 0.1)]}), both)
    assert finding.measured == "forward speed was 0.00 m/s, turning rate was 0.10 rad/s at 7.00 s"
    assert [band.signal for band in finding.bands] == [SPEED, "truth/robot/angular_z"]


def test_a_run_that_ended_before_the_last_seconds_does_not_pass(record):
    """The robot stood still when the run broke off at 3 s: that is no proof that it stood at the end."""
    recording = record({SPEED: [(0, 0.5), (2, 0.0), (3, 0.0)]}, facts={"sim_seconds": 3.0, "unstable": "broke"})
    assert not stays_in_band(recording, PARAMETERS).passed
