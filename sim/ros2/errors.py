"""The errors of commands."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


class CommandError(Exception):
    """An error with a sentence for the user; the command ends with exit code 1."""


class UsageError(CommandError):
    """An invalid command line; the command prints its usage and ends with exit code 2."""


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Return `; did you mean 'x'?` for the known name nearest to `name`; empty when none is near."""
    nearest = difflib.get_close_matches(name, list(known), n=1, cutoff=0.6)
    return f"; did you mean '{nearest[0]}'?" if nearest else ""
