"""`never`: are signals never in a forbidden band?

kind = "never"
conditions = [{ signal = "truth/robot/x", low = 2.0, name = "the robot's x", unit = "m" }]      # all at the same time
window = [0.0, 8.0]       # optional

A node that does nothing passes: give such a check a gate.
"""

from __future__ import annotations

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Band, Finding, check_kind
from gz_course.grader.score.steps import Condition, fulfilled, shown_at, window_of


@check_kind("never")
def never(recording: Recording, parameters: Table) -> Finding:
    """Pass if the conditions never hold all at once, and the simulation covered the whole window."""
    conditions = Condition.read_all(parameters)
    start, end = window_of(recording, parameters)
    edges, holds = fulfilled(recording, conditions, start, end)
    expected = f"never {' and '.join(map(str, conditions))}"
    bands = tuple(Band(c.signal, c.low, c.high, start, end) for c in conditions)
    if holds.any():
        at = float(edges[:-1][holds][0])
        return Finding(False, expected, shown_at(recording, conditions, at), round(at, 3), bands)
    if recording.ended_s < end:
        return Finding(False, expected, f"the simulation ended at {recording.ended_s:.2f} s", None, bands)
    return Finding(True, expected, "never", None, bands)
