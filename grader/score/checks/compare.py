"""`compare`: is one signal equal to another?

kind = "compare"
signal = "topics/estimate/data"
reference = "truth/robot/x"      # its last value before each sample of the signal is compared
factor = 1.0              # optional: wanted is factor * reference + offset
offset = 0.0
tolerance = 0.05          # in the signal's unit; for angles add  angle = true, then full turns make no difference
at_least = 0.95           # of all samples in the window; all but one in twenty if left out
samples = 10              # fewer samples fail; 1 if left out
window = [1.0, 8.0]       # optional
name = "the estimate"     # for the report, as `unit`
"""

from __future__ import annotations

import numpy as np

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding, check_kind
from gz_course.grader.score.steps import told, window_of


@check_kind("compare")
def compare(recording: Recording, parameters: Table) -> Finding:
    """Pass if at least the share `at_least` of the signal's samples lies within `tolerance` of the wanted value."""
    name, other = parameters.text("signal"), parameters.text("reference")
    factor, offset = parameters.number("factor", 1.0), parameters.number("offset", 0.0)
    tolerance = parameters.number("tolerance", above=0)
    share, fewest = parameters.number("at_least", 0.95), parameters.number("samples", 1.0, above=0)
    angle = parameters.flag("angle", False)
    shown = parameters.text("name", name)
    unit = f" {parameters.text('unit')}" if parameters.has("unit") else ""
    start, end = window_of(recording, parameters)
    expected = f"{shown} within {tolerance:g}{unit} of {_wanted(other, factor, offset)}"
    signal, reference = recording.signal(name), recording.signal(other)
    due = (signal.times >= start * 1e9) & (signal.times <= end * 1e9)
    times, values = signal.times[due], signal.values[due]
    index = np.searchsorted(reference.times, times, side="right") - 1
    known = index >= 0
    times, values, index = times[known], values[known], index[known]
    if len(times) < fewest:
        few = f"{len(times)} values, at least {fewest:g} are needed" if len(times) else "nothing was recorded on it"
        return Finding(False, expected, few)
    wanted = factor * reference.values[index] + offset
    off = values - wanted
    if angle:
        off = np.remainder(off + np.pi, 2 * np.pi) - np.pi
    right = np.abs(off) <= tolerance + 1e-9  # 1.05 - 1.0 is slightly more than 0.05 in floating point
    passed = bool(right.sum() >= share * len(right))
    measured = f"{int(right.sum())} of {len(right)} values right"
    part = float(right.mean())
    if right.all():
        return Finding(True, expected, measured, value=part)
    first = int(np.argmin(right))
    at = float(times[first] / 1e9)
    said = f"{told(float(values[first]))}{unit}, wanted was {told(float(wanted[first]))}{unit}"
    measured += f"; at {told(at)} s it was {said}"
    return Finding(passed, expected, measured, None if passed else round(at, 3), value=part)


def _wanted(reference: str, factor: float, offset: float) -> str:
    scaled = reference if factor == 1.0 else f"{factor:g} x {reference}"
    return scaled if not offset else f"{scaled} {'+' if offset > 0 else '-'} {abs(offset):g}"
