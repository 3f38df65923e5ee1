"""The place in a student's file that explains what a check has seen, among the suspects that were found in it."""

from __future__ import annotations

from gz_course.grader.feedback.rules import guarded
from gz_course.grader.printable import shown
from gz_course.grader.record.reading import Recording


@guarded("")
def suspect(recording: Recording, *about: str) -> str:
    """Return words on the first suspect about one of these things, with its line; empty if there is none.

    The nodes of a launch are several files, so the name of the file stands before the line.
    """
    facts = recording.facts()
    found = [each for each in facts.get("suspects", []) if each["about"] in about]
    if not found:
        return ""
    where = f"{found[0]['file']}, line" if "launch" in facts and "file" in found[0] else "line"
    return shown(f"{where} {found[0]['line']}: {found[0]['said']}", 400)
