"""`order`: did events happen in this order?

kind = "order"
events = [                # at least two; see grader/score/events.py
    { topic = "scan_done", name = "the scan is done" },
    { signal = "truth/robot/distance", low = 0.1, name = "the robot sets off" },
    { log = "arrived", name = "the node says that it arrived" },
]

The first occurrence of each event counts. Two at the same time are in order.
"""

from __future__ import annotations

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding, check_kind
from gz_course.grader.score.events import Event
from gz_course.grader.score.steps import told


@check_kind("order")
def order(recording: Recording, parameters: Table) -> Finding:
    """Pass if every event happens and none happens before its predecessor in the list."""
    events = [Event.read(table) for table in parameters.tables("events")]
    if len(events) < 2:
        parameters.refuse("events", "a list of at least two events")
    expected = ", then ".join(event.name for event in events)
    before: tuple[str, float] | None = None
    for event in events:
        moment = event.first(recording)
        if moment is None:
            done = f" after {before[0]} at {told(before[1])} s" if before else ""
            return Finding(False, expected, f"this never happened: {event.name}{done}", None)
        if before is not None and moment < before[1]:
            measured = f"{event.name} at {told(moment)} s, before {before[0]} at {told(before[1])} s"
            return Finding(False, expected, measured, round(moment, 3), timing=True)
        before = event.name, moment
    assert before is not None
    return Finding(True, expected, f"in this order, the last at {told(before[1])} s", round(before[1], 3))
