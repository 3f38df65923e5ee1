"""The place in a student's file that explains what a check has seen, among the suspects that its linter found."""

from __future__ import annotations

from gz_course.grader.printable import shown
from gz_course.grader.record.reading import Recording


def suspect(recording: Recording, *about: str) -> str:
    """Return words on the first suspect about one of these things, with its line; empty if there is none."""
    found = [each for each in recording.facts().get("suspects", []) if each["about"] in about]
    return shown(f"line {found[0]['line']}: {found[0]['said']}", 400) if found else ""
