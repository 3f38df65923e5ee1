"""`change`: by how much did a signal change over a window?

kind = "change"
signal = "truth/robot/yaw"
band = [0.3, 0.7]
window = [0.0, 8.0]       # optional
unit = "rad"
"""

from __future__ import annotations

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Band, Finding, check_kind
from gz_course.grader.score.steps import told, value_at


@check_kind("change")
def change(recording: Recording, parameters: Table) -> Finding:
    """Pass if value at the end minus value at the start lies within `band`."""
    name = parameters.text("signal")
    low, high = parameters.numbers("band", [2])
    start, end = parameters.numbers("window", [2], [0.0, recording.properties("run")["duration"]])
    unit = f" {parameters.text('unit')}" if parameters.has("unit") else ""
    expected = f"{parameters.text('name', name)} changes by {low:g} to {high:g}{unit}"
    last = value_at(recording, name, end)
    if last is None:
        return Finding(False, expected, "nothing was recorded on it")
    if end > recording.ended_s:
        return Finding(False, expected, f"the simulation ended at {recording.ended_s:.2f} s")
    first = value_at(recording, name, start)
    moved = last - (first if first is not None else float(recording.signal(name).values[0]))
    bands = (Band(name, last - moved + low, last - moved + high, end, end),)
    return Finding(bool(low <= moved <= high), expected, f"changed by {told(moved)}{unit}", end, bands, value=moved)
