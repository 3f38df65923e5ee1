"""What can go wrong in the grader, and whose fault it is: the exit code and the outcome follow from the class."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

FEW = 8  # names that can be listed in one sentence


class CourseError(Exception):
    """Base of all errors the `course` command prints as one sentence; `exit_code` goes to the shell."""

    exit_code = 3


class UsageError(CourseError):
    """The command was asked for something that does not exist or cannot be read (exit code 2)."""

    exit_code = 2


class RefusedError(UsageError):
    """A submission that is not taken in because of what it is made of: too large, or leading out of its folder.

    Exit code 2 like any that cannot be read; in a class its outcome is `protocol`.
    """


class UnreadableError(UsageError):
    """The machine did not let us read a submission (exit code 2); in a class this is not the student's loss."""


class ManifestError(CourseError):
    """An exercise's own files are wrong: the author must mend them (exit code 3, never the student's loss)."""


class InfrastructureError(CourseError):
    """The machine or the grader failed (exit code 3, never the student's loss)."""


def nearest(name: str, known: Iterable[str]) -> str:
    """Return a closing clause for an error text: ` (did you mean X?)`, the known names if they are few, or nothing."""
    names = sorted(known)
    lowered: dict[str, str] = {}  # capitals are the commonest mistake of all
    for each in names:
        lowered.setdefault(each.lower(), each)
    close = get_close_matches(name, names, n=1, cutoff=0.9) or get_close_matches(name.lower(), lowered, n=1, cutoff=0.6)
    if close:
        return f" (did you mean {lowered[close[0].lower()] if close[0] not in names else close[0]}?)"
    return f" (known: {', '.join(names)})" if 0 < len(names) <= FEW else ""
