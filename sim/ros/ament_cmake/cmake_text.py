"""Reads the text of a CMakeLists.txt: a list of commands with their arguments; variables are not yet replaced.

Source: cmake-language(7), https://cmake.org/cmake/help/latest/manual/cmake-language.7.html
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from gz_course.sim.ros.ament_cmake.errors import PackageError

_BLANK = re.compile(r"(?:[ \t\r\n]+|#\[(=*)\[.*?\]\1\]|#(?!\[=*\[)[^\n]*)+", re.DOTALL)
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_BRACKET = re.compile(r"\[(=*)\[\n?(.*?)\]\1\]", re.DOTALL)
_QUOTED = re.compile(r'"((?:[^"\\]|\\.)*)"', re.DOTALL)
_UNQUOTED = re.compile(r'(?:[^\s()#"\\]|\\.|"[^"\n]*")+')
_REFERENCE = re.compile(r"\$(ENV|CACHE)?\{((?:[^${}]|\$(?!\{))*)\}")
_ESCAPE = re.compile(r"\\(.)", re.DOTALL)
_LETTERS = {"n": "\n", "t": "\t", "r": "\r", "\n": "", "0": "\0"}
_MOST_REPLACED = 1_000_000  # characters; variables that contain each other grow fast


@dataclass(frozen=True)
class Argument:
    """One argument as written; `kind` is `quoted`, `bracket` or `unquoted`."""

    text: str
    kind: str


@dataclass(frozen=True)
class Command:
    """A command such as `set(NAME value)`; its name is in small letters, as case has no meaning."""

    name: str
    arguments: tuple[Argument, ...]
    line: int


def commands_of(text: str, path: Path | str) -> list[Command]:
    """Return the commands of a text. Raises PackageError for a syntax error."""
    found = []
    place = _skip(text, 0)
    while place < len(text):
        line = _line(text, place)
        name = _NAME.match(text, place)
        if name is None:
            raise PackageError(f"expected the name of a command, found '{text[place]}'", path, line)
        place = _skip(text, name.end(), within_line=True)
        if text[place : place + 1] != "(":
            raise PackageError(f"expected '(' after the name of the command '{name[0]}'", path, line)
        arguments, place = _arguments(text, place + 1, name[0], path, line)
        found.append(Command(name[0].lower(), tuple(arguments), line))
        place = _skip(text, place)
    return found


def values_of(arguments: tuple[Argument, ...], lookup: Callable[[str, str], str]) -> list[str]:
    """Return the values of arguments: variables replaced, lists in unquoted ones taken apart at `;`.

    `lookup` gets the name of a variable and its kind (empty, `ENV` or `CACHE`).
    """
    values: list[str] = []
    for argument in arguments:
        if argument.kind == "bracket":
            values.append(argument.text)
        elif argument.kind == "quoted":
            values.append(_unescaped(_replaced(argument.text, lookup)))
        else:
            parts = re.split(r"(?<!\\);", _replaced(argument.text, lookup))
            values += [_unescaped(part) for part in parts if part]
    return values


def _replaced(text: str, lookup: Callable[[str, str], str]) -> str:
    """Return a text with its variables replaced, inner ones first. What a variable holds is not replaced again."""
    made: list[str] = []

    def keep(match: re.Match[str]) -> str:
        name = re.sub("\0(\\d+)\0", lambda inner: made[int(inner[1])], match[2])
        made.append(lookup(name, match[1] or ""))
        return f"\0{len(made) - 1}\0"

    text = text.replace("\0", "").replace("\\$", "\\\1")
    while (replaced := _REFERENCE.sub(keep, text)) != text:
        text = replaced
    text = re.sub("\0(\\d+)\0", lambda inner: made[int(inner[1])].replace("\\", "\\\\"), text)
    return text.replace("\\\1", "\\$")[:_MOST_REPLACED]


def _unescaped(text: str) -> str:
    return _ESCAPE.sub(lambda match: _LETTERS.get(match[1], match[1]), text)


def _arguments(text: str, place: int, name: str, path: Path | str, begun: int) -> tuple[list[Argument], int]:
    """Return the arguments behind the opening parenthesis, and the place behind the closing one."""
    found: list[Argument] = []
    depth = 1
    while depth:
        place = _skip(text, place)
        if place >= len(text):
            raise PackageError(f"the parenthesis of '{name}(' is never closed; expected ')'", path, begun)
        if text[place] in "()":
            depth += 1 if text[place] == "(" else -1
            if depth:
                found.append(Argument(text[place], "unquoted"))
            place += 1
            continue
        for kind, pattern, group in (("bracket", _BRACKET, 2), ("quoted", _QUOTED, 1), ("unquoted", _UNQUOTED, 0)):
            match = pattern.match(text, place)
            if match:
                found.append(Argument(match[group], kind))
                place = match.end()
                break
        else:
            shown = "this text is never closed; expected another '\"'" if text[place] == '"' else "expected an argument"
            raise PackageError(f"{shown}, in '{name}('", path, _line(text, place))
    return found, place


def _skip(text: str, place: int, within_line: bool = False) -> int:
    """Return the place behind blanks and comments."""
    if within_line:
        while text[place : place + 1] in (" ", "\t"):
            place += 1
        return place
    match = _BLANK.match(text, place)
    return match.end() if match else place


def _line(text: str, place: int) -> int:
    return text.count("\n", 0, place) + 1
