"""Substitutions written as `$(name argument ...)` in a text.

A package adds its own with `expose_substitution`, as launch_ros does.

Source: ros2/launch, launch/launch/frontend/grammar.lark; the names are those of XML launch files
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.launch.substitution import Substitution
from gz_course.sim.launch.substitutions import (
    AnonName,
    Command,
    EnvironmentVariable,
    FileContent,
    FindExecutable,
    LaunchConfiguration,
    LaunchLogDir,
    PythonExpression,
    SubstitutionFailure,
    TextSubstitution,
    ThisLaunchFile,
    ThisLaunchFileDir,
)

Arguments = Sequence[list[Substitution]]
_makers: dict[str, tuple[int, int, Callable[..., Substitution]]] = {
    "var": (1, 2, lambda name, default=None: LaunchConfiguration(name, default=default)),
    "env": (1, 2, lambda name, default=None: EnvironmentVariable(name, default_value=default)),
    "eval": (1, 1, PythonExpression),
    "command": (1, 2, lambda command, on_stderr="fail": Command(command, on_stderr=on_stderr)),
    "find-exec": (1, 1, lambda name: FindExecutable(name=name)),
    "file-content": (1, 1, FileContent),
    "anon": (1, 1, AnonName),
    "dirname": (0, 0, ThisLaunchFileDir),
    "filename": (0, 0, ThisLaunchFile),
    "log_dir": (0, 0, LaunchLogDir),
}


def expose_substitution(name: str, at_least: int, at_most: int, make: Callable[..., Substitution]) -> None:
    """Register `$(name ...)` as `make(...)`, called with `at_least` to `at_most` lists of substitutions."""
    _makers[name] = (at_least, at_most, make)


def parse_substitution(text: str) -> list[Substitution]:
    """Parse a text into a list of substitutions. Raises SubstitutionFailure for invalid text."""
    parts, end = _parse_parts(text, 0, nested=False)
    assert end == len(text)
    return parts


def _parse_parts(text: str, start: int, *, nested: bool) -> tuple[list[Substitution], int]:
    """Parse text and substitutions from `start` to the end, or to a blank or `)` if nested; return them and the end."""
    parts: list[Substitution] = []
    plain: list[str] = []
    quote = ""
    while start < len(text):
        letter = text[start]
        if text.startswith(("\\$", "\\(", "\\)"), start) or (nested and text.startswith(("\\'", '\\"'), start)):
            plain.append(text[start + 1])
            start += 2
        elif text.startswith("$(", start):
            if plain:
                parts.append(TextSubstitution(text="".join(plain)))
                plain = []
            substitution, start = _parse_call(text, start)
            parts.append(substitution)
        elif nested and letter in "'\"" and quote in ("", letter):
            quote = "" if quote else letter
            start += 1
        elif nested and not quote and (letter.isspace() or letter == ")"):
            break
        else:
            plain.append(letter)
            start += 1
    if quote:
        raise SubstitutionFailure(f"a quote {quote} is not closed in {text!r}")
    if plain or not parts:
        parts.append(TextSubstitution(text="".join(plain)))
    return parts, start


def _parse_call(text: str, start: int) -> tuple[Substitution, int]:
    """Parse the `$(name argument ...)` at `start`; return the substitution and its end."""
    position = start + 2
    words: list[list[Substitution]] = []
    while True:
        while position < len(text) and text[position].isspace():
            position += 1
        if position >= len(text):
            raise SubstitutionFailure(f"a ) is missing after {text[start : start + 40]!r}")
        if text[position] == ")":
            break
        word, position = _parse_parts(text, position, nested=True)
        words.append(word)
    return _make(words, text[start : position + 1]), position + 1


def _make(words: list[list[Substitution]], source: str) -> Substitution:
    first: Any = words[0][0] if words and len(words[0]) == 1 else None
    if not isinstance(first, TextSubstitution):
        raise SubstitutionFailure(f"{source!r} does not begin with the name of a substitution")
    if first.text not in _makers:
        hint = did_you_mean(first.text, _makers, listing="there are")
        raise SubstitutionFailure(f"there is no substitution $({first.text} ...){hint}")
    at_least, at_most, make = _makers[first.text]
    if not at_least <= len(words) - 1 <= at_most:
        wanted = str(at_least) if at_least == at_most else f"{at_least} to {at_most}"
        raise SubstitutionFailure(f"{source!r} has {len(words) - 1} arguments; {first.text} takes {wanted}")
    return make(*words[1:])
