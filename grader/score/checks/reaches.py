"""`reaches`: did an event happen at least once in a window?

kind = "reaches"
event = { signal = "truth/robot/x", low = 1.0, name = "the robot passes the gate" }     # see grader/score/events.py
window = [0.0, 6.0]       # optional

An event is a signal in its band, a message (with a given text), or a line of the node's log.
"""

from __future__ import annotations

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Band, Finding, check_kind
from gz_course.grader.score.events import Event
from gz_course.grader.score.steps import told, window_of


@check_kind("reaches")
def reaches(recording: Recording, parameters: Table) -> Finding:
    """Pass if the event happens in the window."""
    event = Event.read(parameters.table("event"))
    start, end = window_of(recording, parameters)
    expected = f"{event.name}, between {start:g} and {end:g} s"
    moment, ever = event.first(recording, start), event.first(recording)
    bands: tuple[Band, ...] = ()
    if (condition := event.condition) is not None:
        bands = (Band(condition.signal, condition.low, condition.high, start, end),)
    if moment is not None and moment <= end:
        return Finding(True, expected, f"at {told(moment)} s", round(moment, 3), bands)
    late = moment if moment is not None else ever
    if late is not None:
        return Finding(False, expected, f"only at {told(late)} s", round(late, 3), bands, timing=True)
    return Finding(False, expected, f"never{_nearest(recording, event)}", None, bands)


def _nearest(recording: Recording, event: Event) -> str:
    """Return in words how near a signal came to its band."""
    if (condition := event.condition) is None:
        return ""
    values = recording.signal(condition.signal).values
    if not len(values):
        return "; nothing was recorded on it"
    best = values.max() if values.max() < condition.low else values.min()
    return f"; the nearest it came was {told(float(best))}{condition.unit}"
