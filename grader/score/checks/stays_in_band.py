"""`stays_in_band`: were signals in their bands without interruption to the end of the run?

kind = "stays_in_band"
conditions = [{ signal = "truth/robot/linear_x", low = -0.02, high = 0.02, unit = "m/s" }]
last = 1.5                # [s] before the end of the run
command = "topics/cmd_vel/linear/x"    # optional: the command to quote if the check fails
"""

from __future__ import annotations

import numpy as np

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Band, Finding, check_kind
from gz_course.grader.score.steps import Condition, fulfilled, shown_at, told

STILL = 0.5  # [s] before the end: a later command means that commands never ceased


@check_kind("stays_in_band")
def stays_in_band(recording: Recording, parameters: Table) -> Finding:
    """Pass if every condition holds at every moment of the last `last` seconds."""
    conditions = Condition.read_all(parameters)
    last = parameters.number("last", above=0)
    command = parameters.text("command") if parameters.has("command") else None
    end = recording.properties("run")["duration"]
    start = end - last
    edges, holds = fulfilled(recording, conditions, start, end)
    wanted = " and ".join(map(str, conditions))
    expected = f"{wanted} from {start:g} s to the end at {end:g} s"
    bands = tuple(Band(c.signal, c.low, c.high, start, end) for c in conditions)
    if holds.all():
        return Finding(True, expected, "so it did", end, bands)
    at = float(edges[:-1][~holds][0])
    measured = shown_at(recording, conditions, at) + _last_command(recording, command, end)
    return Finding(False, expected, measured, float(np.round(at, 3)), bands, timing=True)


def _last_command(recording: Recording, command: str | None, end: float) -> str:
    """Return in words the last value of a command and when it came."""
    signal = recording.signal(command) if command else None
    if not signal:
        return ""
    time, value = signal.times[-1] / 1e9, signal.values[-1]
    if time > end - STILL and value:
        return f"; commands of {told(value)} were still coming at {time:.2f} s"
    return f"; the last command came at {time:.2f} s and was {told(value)}"
