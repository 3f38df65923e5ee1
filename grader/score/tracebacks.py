"""Tracebacks in the output of a program: the error they end in, and the places they name."""

from __future__ import annotations

import re
from collections.abc import Sequence

FRAME = re.compile(r'\s+File "(.*)", line (\d+)')


NOT_THEIRS = ("/site-packages/", "/lib/python3", "/sim/", "/gz_course/", "<")  # parts of paths of installed code


def read_traceback(lines: Sequence[str]) -> tuple[str, list[tuple[str, str]]]:
    """Return the first line of the error a traceback ends in, and the (file name, line) of each frame."""
    places = []
    for line in lines:
        if match := FRAME.match(line):
            places.append((match.group(1).rpartition("/")[2], match.group(2)))
        elif line and not line.startswith((" ", "Traceback")):
            return line, places
    return "", places


def last_traceback(lines: Sequence[str]) -> Sequence[str]:
    """Return the lines from the last traceback on; a syntax error found at run time has no first line."""
    starts = [i for i, line in enumerate(lines) if line.startswith(("Traceback (most recent", '  File "'))]
    return lines[max((i for i in starts if lines[i].startswith("Traceback")), default=starts[0]) :] if starts else []


def own_place(lines: Sequence[str]) -> str:
    """Return in words the last place of a traceback that is not in installed code; empty if there is none."""
    frames = [match.groups() for line in lines if (match := FRAME.match(line))]
    mine = [(path, number) for path, number in frames if not any(part in path for part in NOT_THEIRS)]
    return f"{mine[-1][0].rpartition('/')[2]}, line {mine[-1][1]}" if mine else ""
