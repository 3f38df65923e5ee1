"""Finds expected text in the output of a process."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

TextMatch = Callable[..., tuple[int, int] | None]
LineMatch = Callable[..., tuple[int, int] | None]


def normalize_lineseps(lines: str) -> str:
    return lines.replace("\r\n", "\n")


def build_text_match(expected_text: Any, *, strict: bool = False) -> TextMatch:
    """Return a function(text, start=0) that returns the begin and end of the expected text in it, or None.

    A list of texts and patterns is found in its order. `strict`: the text is this and nothing else, a pattern begins
    where the text begins, and items of a list follow one another directly.
    """
    if isinstance(expected_text, str):
        return lambda text, start=0: _find_text(normalize_lineseps(text), expected_text, start, strict)
    if hasattr(expected_text, "search"):
        return lambda text, start=0: _find_pattern(normalize_lineseps(text), expected_text, start, strict)
    if not isinstance(expected_text, Iterable):
        raise ValueError("Unknown format for expected text")
    return _in_order([build_text_match(item) for item in expected_text], strict)


def build_line_match(expected_lines: Any, *, strict: bool = False) -> LineMatch:
    """Return a function(lines, start=0) that returns the first and the last + 1 of the expected lines, or None.

    An expected line is a part of a line, or a pattern at its beginning; a list of them is found in its order. `strict`:
    all lines are equal to the expected one, or match it; items of a list follow one another directly.
    """
    if isinstance(expected_lines, str):
        return _line_match(lambda line: line == expected_lines if strict else expected_lines in line, strict)
    if hasattr(expected_lines, "match"):
        return _line_match(lambda line: expected_lines.match(line) is not None, strict)
    if not isinstance(expected_lines, Iterable):
        raise ValueError("Unknown format for expected lines")
    return _in_order([build_line_match(item) for item in expected_lines], strict)


def _find_text(text: str, expected: str, start: int, strict: bool) -> tuple[int, int] | None:
    if strict:
        return (start, start + len(expected)) if text[start:] == expected else None
    found = text.find(expected, start)
    return None if found < 0 else (found, found + len(expected))


def _find_pattern(text: str, pattern: Any, start: int, strict: bool) -> tuple[int, int] | None:
    found = pattern.match(text, start) if strict else pattern.search(text, start)
    return None if found is None else (found.start(), found.end())


def _line_match(fits: Callable[[str], bool], strict: bool) -> LineMatch:
    def match(lines: list[str], start: int = 0) -> tuple[int, int] | None:
        if strict:
            return (start, len(lines)) if all(map(fits, lines[start:])) else None
        return next(((i, i + 1) for i in range(start, len(lines)) if fits(lines[i])), None)

    return match


def _in_order(matches: list[Callable[..., tuple[int, int] | None]], strict: bool) -> TextMatch:
    def match(whole: Any, start: int = 0) -> tuple[int, int] | None:
        begin, end = None, start
        for each in matches:
            found = each(whole, end)
            if found is None or (strict and found[0] != end):
                return None
            begin = found[0] if begin is None else begin
            end = found[1]
        return (start if begin is None else begin, end)

    return match
