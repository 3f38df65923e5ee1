"""`time_in_band`: how long were one or more signals in their bands at the same time?

kind = "time_in_band"
conditions = [{ signal = "truth/robot/linear_x", low = 0.45, high = 0.55, unit = "m/s" }]
seconds = [4.7, 5.35]     # at least, at most; the second may be left out
window = [0.0, 8.0]       # optional
"""

from __future__ import annotations

import numpy as np

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Band, Finding, check_kind
from gz_course.grader.score.steps import Condition, fulfilled, told


@check_kind("time_in_band")
def time_in_band(recording: Recording, parameters: Table) -> Finding:
    """Pass if the total time in band lies within `seconds`."""
    conditions = Condition.read_all(parameters)
    start, end = parameters.numbers("window", [2], [0.0, recording.properties("run")["duration"]])
    least, *rest = parameters.numbers("seconds", [1, 2])
    most = rest[0] if rest else np.inf
    edges, holds = fulfilled(recording, conditions, start, end)
    total = float(np.diff(edges)[holds].sum())
    wanted = " and ".join(map(str, conditions))
    span = f"for {least:g} to {most:g} s" if rest else f"for at least {least:g} s"
    if not any(len(recording.signal(c.signal)) for c in conditions):
        return Finding(False, f"{wanted} {span}", "nothing was recorded on it", None)
    measured = f"in band for {total:.2f} s"
    if not least <= total <= most:
        measured += "".join(f"; {c.name} {_usual(recording, c)}" for c in conditions)
    at = float(edges[1:][holds][-1]) if holds.any() else None
    bands = tuple(Band(c.signal, c.low, c.high, start, end) for c in conditions)
    passed, was_right = bool(least <= total <= most), _was_right(recording, conditions)
    return Finding(passed, f"{wanted} {span}", measured, at, bands, timing=was_right, value=total)


def _was_right(recording: Recording, conditions: list[Condition]) -> bool:
    """Return whether every signal was in its band at some time, if only between two samples."""
    values = [recording.signal(c.signal).values for c in conditions]
    return all(bool(np.any((v >= c.low) & (v <= c.high))) for c, v in zip(conditions, values, strict=True))


def _usual(recording: Recording, c: Condition) -> str:
    """Return in words the values of a signal: the usual one that is not 0, and how often it is 0 if that is oftener."""
    values = recording.signal(c.signal).values
    moving = values[np.abs(values) > 0.01]
    if not len(moving):
        return "was always 0" if len(values) else "was never seen"
    usual = f"{told(float(np.median(moving)))}{c.unit}"
    if 2 * len(moving) < len(values):
        return f"was {usual} in {len(moving)} of {len(values)} values and 0 in the others"
    return f"was mostly {usual}"
