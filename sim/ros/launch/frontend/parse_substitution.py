"""Substitutions written as `$(name argument ...)` in a text.

A package adds its own with `expose_substitution`, or with `add_substitution` as launch_ros does.

Source: ros2/launch, launch/launch/frontend/grammar.lark; the names are those of XML launch files
"""

from __future__ import annotations

import re
from typing import Any

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.launch.frontend.expose import add_substitution, substitution_parse_methods
from gz_course.sim.ros.launch.frontend.extensions import load_foreign_extensions
from gz_course.sim.ros.launch.substitution import Substitution
from gz_course.sim.ros.launch.substitutions import (
    AllSubstitution,
    AndSubstitution,
    AnonName,
    AnySubstitution,
    Command,
    EnvironmentVariable,
    EqualsSubstitution,
    FileContent,
    FindExecutable,
    IfElseSubstitution,
    LaunchConfiguration,
    LaunchLogDir,
    NotEqualsSubstitution,
    NotSubstitution,
    OrSubstitution,
    PythonExpression,
    SubstitutionFailure,
    TextSubstitution,
    ThisLaunchFile,
    ThisLaunchFileDir,
)

_MANY = float("inf")
# Those of ROS 1, and what people try: name -> what to write.
_OTHER_NAMES = {
    "arg": "$(var NAME)",
    "find": "$(find-pkg-share PACKAGE)",
    "find-pkg": "$(find-pkg-share PACKAGE)",
    "optenv": "$(env NAME DEFAULT)",
    "python": "$(eval 'EXPRESSION')",
}


def _add_substitutions() -> None:
    add_substitution("var", 1, 2, lambda name, default=None: LaunchConfiguration(name, default=default))
    add_substitution("env", 1, 2, lambda name, default=None: EnvironmentVariable(name, default_value=default))
    add_substitution("eval", 1, 2, _python_expression)
    add_substitution("command", 1, 2, lambda command, on_stderr="fail": Command(command, on_stderr=on_stderr))
    add_substitution("find-exec", 1, 1, lambda name: FindExecutable(name=name))
    add_substitution("file-content", 1, 1, FileContent)
    add_substitution("anon", 1, 1, AnonName)
    add_substitution("dirname", 0, 0, ThisLaunchFileDir)
    add_substitution("filename", 0, 0, ThisLaunchFile)
    for name in ("log_dir", "launch_log_dir"):
        add_substitution(name, 0, 0, LaunchLogDir)
    add_substitution("not", 1, 1, NotSubstitution)
    add_substitution("and", 2, 2, AndSubstitution)
    add_substitution("or", 2, 2, OrSubstitution)
    add_substitution("any", 1, _MANY, AnySubstitution)
    add_substitution("all", 1, _MANY, AllSubstitution)
    add_substitution("equals", 2, 2, EqualsSubstitution)
    add_substitution("not-equals", 2, 2, NotEqualsSubstitution)
    add_substitution("if", 1, 3, IfElseSubstitution)


def _python_expression(expression: list[Substitution], modules: list[Substitution] | None = None) -> Substitution:
    if modules is None:
        return PythonExpression(expression)
    names = "".join(each.text for each in modules if isinstance(each, TextSubstitution))
    return PythonExpression(expression, [name.strip() for name in names.split(",")])


_add_substitutions()


def replace_escaped_characters(text: str) -> str:
    """Return a text in which each backslash is gone, and the character after it stays."""
    return re.sub(r"\\(.)", r"\1", text)


def parse_if_substitutions(value: Any) -> Any:
    """Return a text without substitutions as it is, another as a list of them; items of a list likewise."""
    if isinstance(value, list):
        return [parse_if_substitutions(each) for each in value]
    if not isinstance(value, str):
        return value
    parts = parse_substitution(value)
    return parts[0].text if len(parts) == 1 and isinstance(parts[0], TextSubstitution) else parts


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
    name = first.text
    if name not in substitution_parse_methods:
        load_foreign_extensions()
    if name not in substitution_parse_methods:
        other = _OTHER_NAMES.get(name)
        hint = f"; write {other}" if other else did_you_mean(name, substitution_parse_methods, listing="there are")
        raise SubstitutionFailure(f"there is no substitution $({name} ...){hint}")
    at_least, at_most, make = substitution_parse_methods[name]
    if not at_least <= len(words) - 1 <= at_most:
        wanted = str(at_least) if at_least == at_most else f"{at_least} to {at_most}"
        wanted = f"{at_least} or more" if at_most == _MANY else wanted
        hint = "; one with blanks needs quotes" if len(words) - 1 > at_most > 0 else ""
        raise SubstitutionFailure(f"{source!r} has {len(words) - 1} arguments; {name} takes {wanted}{hint}")
    return make(words[1:])
