"""The errors of commands."""

from __future__ import annotations


class CommandError(Exception):
    """The sentence for the user; the command ends with exit code 1."""


class UsageError(CommandError):
    """A command line that cannot be understood; the command prints its usage and ends with exit code 2."""
