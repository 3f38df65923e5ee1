"""A node that ends by itself before its run is over: when, and which line of its file ends it."""

from __future__ import annotations

from gz_course.grader.feedback.rules import guarded
from gz_course.grader.printable import shown
from gz_course.grader.record.reading import Recording


@guarded("")
def ended_by_itself(recording: Recording, before: float | None = None) -> str:
    """Return when a node ended by itself, without an error, and where; empty if it ran on.

    `before` [s] is when what has to be explained happened.
    """
    facts = recording.facts()
    at = facts.get("exit_at")
    if at is None or facts.get("exit_code") not in (None, 0) or (before is not None and at > before):
        return ""
    place = next(iter(facts.get("own_ends", [])), None)
    where = f": line {place['line']}: {place['said']}" if place else ", and nothing of it runs after that"
    return shown(f"the node's process ended by itself at {at:.1f} s (exit code 0){where}", 400)
