"""A robot that goes on by its last command."""

from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pytest

from gz_course.grader.record.reading import Signal

LAST = import_module("gz_course.exercises.13_capstone.grading.last_commands")


def recording(times, ahead, **facts):
    at = np.round(np.asarray(times) * 1e9).astype(np.int64)
    values = {"topics/cmd_vel/linear/x": np.asarray(ahead), "topics/cmd_vel/angular/z": 0.0 * np.asarray(ahead)}
    return SimpleNamespace(signal=lambda name: Signal(at, values[name]), end_ns=36_000_000_000, facts=lambda: facts)


@pytest.mark.parametrize(
    ("until", "speed", "touched", "words"),
    [
        (10.0, 0.4, 14.0, "no command came for 4.1 s after that of 9.9 s, with linear.x 0.40"),
        (10.0, 0.4, 10.3, ""),
        (10.0, 0.0, 14.0, ""),
        (10.0, 0.4, None, "no command came for 26.1 s after that of 9.9 s"),
        (33.0, 0.4, None, ""),
        (10.0, 0.0, None, ""),
    ],
)
def test_a_robot_that_goes_on_by_its_last_command(until, speed, touched, words):
    times = np.arange(0.0, until, 0.1)
    said = LAST.kept(recording(times, np.full(len(times), speed)), touched)
    assert words in said if words else said == ""


def test_a_robot_whose_node_has_ended():
    times = np.arange(0.0, 10.0, 0.1)
    ends = [{"file": "mapper_node.py", "line": 7, "said": "`sys.exit()` in plan() ends the program"}]
    said = LAST.kept(recording(times, np.full(100, 0.4), exit_at=9.95, exit_code=0, own_ends=ends), 14.0)
    assert "ended by itself at 9.9 s (exit code 0): line 7: `sys.exit()`" in said or "at 10.0 s" in said
