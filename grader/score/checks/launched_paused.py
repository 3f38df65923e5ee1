"""`launched_paused`: does simulated time stand still if, and only if, an argument of the launch says so?

kind = "launched_paused"
argument = "paused"
default = false

It is judged by the time that passed. Whether `gz sim` had -r, or the control service was asked later, is the same.
"""

from __future__ import annotations

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding, check_kind
from gz_course.grader.score.launched import argument, declared, ran


@check_kind("launched_paused")
def launched_paused(recording: Recording, parameters: Table) -> Finding:
    """Pass if no simulated time passed when a paused world was asked for, and some did when not."""
    default = "true" if parameters.flag("default") else "false"
    name = parameters.text("argument")
    wanted, called = argument(recording, name, default)
    pause = wanted.strip().lower() in ("true", "1")
    running = ran(recording)
    expected = f"{called}: the world {'is paused' if pause else 'runs'}"
    if not running:
        return Finding(False, expected, "no simulator ran")
    found = not recording.facts().get("sim_seconds")
    state = "was paused" if found else "ran"
    if found == running[0]["paused"]:
        state += ": gz sim had no -r" if found else ": gz sim had -r"
    why = "" if found == pause else declared(recording, name, default)
    return Finding(found == pause, expected, f"{called} it {state}", explanation=why)
