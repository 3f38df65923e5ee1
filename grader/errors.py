"""What can go wrong in the grader, and whose fault it is: the exit code and the outcome follow from the class."""

from __future__ import annotations


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
