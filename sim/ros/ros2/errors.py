"""The errors of commands."""

from __future__ import annotations


class CommandError(Exception):
    """An error with a sentence for the user; the command ends with exit code 1."""


class UsageError(CommandError):
    """An invalid command line; the command prints its usage and ends with exit code 2."""
