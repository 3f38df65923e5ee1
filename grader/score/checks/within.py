"""`within`: were signals in their bands without interruption for some seconds from a given time on?

kind = "within"
conditions = [{ signal = "truth/robot/linear_x", low = 0.45, high = 0.55, name = "forward speed", unit = "m/s" }]
start = 5.0               # [s] of simulated time; or
after = { topic = "start" }      # from this event on (see grader/score/events.py), and then
settle = 0.5              # optional: [s] to get into the band
seconds = 1.0             # [s] length

A node that does nothing may be within a band: give such a check a gate.
"""

from __future__ import annotations

import numpy as np

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Band, Finding, check_kind
from gz_course.grader.score.events import Event
from gz_course.grader.score.steps import Condition, fulfilled, shown_at


@check_kind("within")
def within(recording: Recording, parameters: Table) -> Finding:
    """Pass if every condition holds during the `seconds` that begin at `start` or after `after`."""
    conditions = Condition.read_all(parameters)
    seconds = parameters.number("seconds", above=0)
    event = Event.read(parameters.table("after")) if parameters.has("after") else None
    settle = parameters.number("settle", 0.0)
    begin: float | None = parameters.number("start") if event is None else event.first(recording)
    wanted = " and ".join(map(str, conditions))
    if begin is None:
        assert event is not None
        return Finding(False, f"{wanted} for {seconds:g} s after {event.name}", f"this never happened: {event.name}")
    start, end = begin + settle, begin + settle + seconds
    edges, holds = fulfilled(recording, conditions, start, end)
    expected = f"{wanted} from {start:g} s to {end:g} s"
    bands = tuple(Band(c.signal, c.low, c.high, start, end) for c in conditions)
    if holds.all():
        return Finding(True, expected, "so it did", round(end, 3), bands)
    at = float(edges[:-1][~holds][0])
    return Finding(
        False, expected, shown_at(recording, conditions, at), float(np.round(at, 3)), bands, timing=bool(holds.any())
    )
