"""A submission as tokens: names, numbers and texts without their spelling, no comments, no blanks.

So renamed variables, other comments and other line breaks make no difference. Pygments reads the texts; it runs
nothing of them. What takes it too long is left out and reported: submissions are hostile.
"""

from __future__ import annotations

import contextlib
import signal
import warnings
import zlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import PurePosixPath
from types import FrameType

import numpy as np
from numpy.typing import NDArray
from pygments import token
from pygments.lexers import get_lexer_by_name

LEXERS = {
    ".py": "python", ".xml": "xml", ".launch": "xml", ".sdf": "xml", ".world": "xml", ".urdf": "xml", ".xacro": "xml",
    ".yaml": "yaml", ".yml": "yaml", ".cpp": "cpp", ".hpp": "cpp", ".h": "cpp", ".c": "c",
}  # fmt: skip
LARGEST = 256 << 10  # [bytes] of a file that is compared
LONGEST = 2.0  # [s] of processor time to read a file
MOST_TOKENS = 50_000  # of a submission


@dataclass(frozen=True)
class Text:
    """The tokens of a submission: `symbols` (n,), and for each its line and the number of its file in `names`."""

    symbols: NDArray[np.uint64]
    lines: NDArray[np.int32]
    files: NDArray[np.int32]
    names: tuple[str, ...]
    left_out: tuple[str, ...] = ()


class TooLongError(Exception):
    """A file takes too long to read."""


def read_text(files: Mapping[str, bytes], main: str = "") -> Text:
    """Return the tokens of the files that have a lexer; `main` is read as Python, whatever its suffix."""
    symbols: list[int] = []
    lines: list[int] = []
    numbers: list[int] = []
    names: list[str] = []
    left_out: list[str] = []
    for name, data in sorted(files.items()):
        lexer = LEXERS.get(PurePosixPath(name).suffix, "python" if name == main else "")
        if not lexer:
            continue
        if len(data) > LARGEST or b"\0" in data:
            left_out.append(f"{name} has {len(data)} bytes" if len(data) > LARGEST else f"{name} is no text")
            continue
        try:
            with _within(LONGEST):
                found = list(_symbols(lexer, data.decode("utf-8", "replace")))
        except (TooLongError, RecursionError, MemoryError):
            left_out.append(f"{name} takes too long to read")
            continue
        number = len(names)
        names.append(name)
        for symbol, line in found[: MOST_TOKENS - len(symbols)]:
            symbols.append(symbol)
            lines.append(line)
            numbers.append(number)
    return Text(
        np.array(symbols, np.uint64), np.array(lines, np.int32), np.array(numbers, np.int32), tuple(names),
        tuple(left_out),
    )  # fmt: skip


def _symbols(lexer: str, text: str) -> Iterator[tuple[int, int]]:
    """Yield a number for each token, and its line."""
    line, string = 1, False
    for kind, value in get_lexer_by_name(lexer, stripnl=False, ensurenl=False).get_tokens(text):
        word = _word(kind, value)
        if word and not (string and word == "S"):  # the pieces of a text, quotes included, are one token
            yield zlib.crc32(word.encode()) + 1, line
        if value.strip():
            string = word == "S"
        line += value.count("\n")


def _word(kind: token._TokenType, value: str) -> str:
    if kind in token.Comment or kind in token.String.Doc or kind in token.Text or not value.strip():
        return ""
    if kind in token.Name and kind not in token.Name.Tag:
        return "N"
    if kind in token.Number:
        return "0"
    if kind in token.String:
        return "S"
    return value.strip()


@contextlib.contextmanager
def _within(seconds: float) -> Iterator[None]:
    """Raise TooLongError in the block after this much processor time [s] of the process; for the main thread only."""

    def late(_number: int, _frame: FrameType | None) -> None:
        raise TooLongError

    before = signal.signal(signal.SIGVTALRM, late)
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)
