"""`count`: how many samples of a signal lie in a band? A sample is one message, or one tick of the truth.

kind = "count"
signal = "topics/cmd_vel/linear/x"
low = 0.45                # either may be left out
high = 0.55
count = [40, 60]          # at least, at most; the second may be left out
window = [0.0, 8.0]       # optional
name = "linear.x on /cmd_vel"    # for the report, as `unit`
"""

from __future__ import annotations

import numpy as np

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Band, Finding, check_kind
from gz_course.grader.score.steps import how_many, told, window_of


@check_kind("count")
def count(recording: Recording, parameters: Table) -> Finding:
    """Pass if the number of samples in the band and in the window lies within `count`."""
    name = parameters.text("signal")
    low = parameters.number("low", -np.inf, infinite=True)
    high = parameters.number("high", np.inf, infinite=True)
    shown = parameters.text("name", name)
    unit = f" {parameters.text('unit')}" if parameters.has("unit") else ""
    least, *rest = parameters.numbers("count", [1, 2])
    most = rest[0] if rest else np.inf
    start, end = window_of(recording, parameters)
    signal = recording.signal(name)
    times = signal.times / 1e9
    due = (times >= start) & (times <= end)
    held = due & (signal.values >= low) & (signal.values <= high)
    number = int(held.sum())
    expected = f"{how_many(least, most)} values of {shown} in {low:g} to {high:g}{unit}"
    measured = f"{number} of {int(due.sum())}" if due.any() else "nothing was recorded on it"
    passed = bool(least <= number <= most)
    outside = signal.values[due & ~held]
    if not passed and len(outside):
        measured += f"; the others were mostly {told(float(np.median(outside)))}{unit}"
    at = float(times[held][-1]) if number else None
    return Finding(
        passed, expected, measured, at, (Band(name, low, high, start, end),), timing=number > 0, value=number
    )
