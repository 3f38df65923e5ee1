"""The grader's errors. The class of an error decides its exit code, its outcome, and who is at fault."""

from __future__ import annotations


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


class Interrupted(CourseError):
    """The user pressed Ctrl-C (exit code 130, as a shell has it)."""

    exit_code = 130
