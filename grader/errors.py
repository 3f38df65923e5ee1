"""The grader's errors. The class of an error decides its exit code, its outcome, and who is at fault."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

FEW = 8  # names listed in one sentence at most


class CourseError(Exception):
    """Base of all errors that `course` prints as one sentence before it exits with `exit_code`."""

    exit_code = 3


class UsageError(CourseError):
    """The user asked for something that does not exist or cannot be read (exit code 2)."""

    exit_code = 2


class RefusedError(UsageError):
    """A submission is refused for what it consists of: it is too large, or leads out of its folder.

    Exit code 2, as for any submission that cannot be read; in a class its outcome is `protocol`.
    """


class UnreadableError(UsageError):
    """The machine could not read a submission (exit code 2); in a class this costs the student no points."""


class ManifestError(CourseError):
    """The exercise's own files are wrong: its author must mend them (exit code 3, costs the student no points)."""


class InfrastructureError(CourseError):
    """The machine or the grader failed (exit code 3, costs the student no points)."""


def nearest(name: str, known: Iterable[str]) -> str:
    """Return the end of an error text: ` (did you mean X?)`, else the known names if they are few, else nothing."""
    names = sorted(known)
    lowered: dict[str, str] = {}  # wrong capitals are the most frequent mistake
    for each in names:
        lowered.setdefault(each.lower(), each)
    close = get_close_matches(name, names, n=1, cutoff=0.9) or get_close_matches(name.lower(), lowered, n=1, cutoff=0.6)
    if close:
        return f" (did you mean {lowered[close[0].lower()] if close[0] not in names else close[0]}?)"
    return f" (known: {', '.join(names)})" if 0 < len(names) <= FEW else ""
