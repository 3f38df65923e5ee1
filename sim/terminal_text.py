"""What our commands print is made fit for a terminal at one place, where it leaves the process.

Names come from bags, worlds, files and nodes of others, and a terminal obeys control codes that stand in them: it moves
the cursor, renames the window, or types. `guard` puts a filter before standard output and standard error.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable
from typing import Any, TextIO

# Control codes but the tabulator and the end of a line; "\\r" alone would let a line be written over.
# Source: Unicode 15.0, general category Cc (C0, delete, C1).
_CONTROL = re.compile("[\0-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f]|\r(?!\n)")


def printable(text: str) -> str:
    """Return a text in which every code that a terminal obeys is replaced by U+FFFD."""
    return _CONTROL.sub("\N{REPLACEMENT CHARACTER}", text)


class _Filter:
    """A text stream that writes what is printable; all else is that of the stream behind it."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def write(self, text: str) -> int:
        self._stream.write(printable(text))
        return len(text)

    def writelines(self, lines: Iterable[str]) -> None:
        for line in lines:
            self.write(line)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


def unguarded(stream: TextIO) -> TextIO:
    """Return the stream behind the filter, for who writes control codes of its own and replaces those of others."""
    return stream._stream if isinstance(stream, _Filter) else stream


def guard() -> None:
    """Let this process print no control codes from now on; bytes, and what its children print, are not changed."""
    for name in ("stdout", "stderr"):
        stream: Any = getattr(sys, name)
        if stream is not None and not isinstance(stream, _Filter):
            setattr(sys, name, _Filter(stream))
