"""The errors that end a ROS program with a sentence and an exit code."""

from __future__ import annotations

import re


class UsageError(Exception):
    """Arguments or parameters that cannot be used; ends the program with exit code 2.

    `sentences` holds one sentence for each fault.
    """

    def __init__(self, *sentences: str) -> None:
        super().__init__("\n".join(sentences))
        self.sentences = sentences


class Failure(Exception):
    """A task that could not be done; its text is one sentence, and it ends the program with exit code 1."""


def first_line(error: BaseException) -> str:
    """Return the first line of an error's text without places in ROS's C sources, or its type if it has no text."""
    line = next(iter(str(error).splitlines()), "").strip()
    return re.sub(r", at /\S+:\d+", "", line) or type(error).__name__
