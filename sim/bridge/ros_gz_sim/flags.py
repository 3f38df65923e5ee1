"""Options of ros_gz_sim's programs: `-name box`, `--name box`, `-name=box`, or a ROS parameter.

A program declares a list of `Flag`; `read` parses the command line, and `with_parameters` replaces values by the
parameters of the node. Both raise UsageError.

Source: gflags, which the original programs use, https://gflags.github.io/gflags/#commandline
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.ros_program.errors import UsageError

if TYPE_CHECKING:
    from rclpy.node import Node

_SWITCH = {"true": True, "1": True, "t": True, "yes": True, "false": False, "0": False, "f": False, "no": False}


@dataclass(frozen=True)
class Flag:
    """One option. `kind` is `text`, `number` (finite), `whole` (0 or more) or `switch`; `count` values follow it."""

    name: str
    about: str
    kind: str = "text"
    count: int = 1
    parameter: bool = True
    """True if a ROS parameter of the same name also sets it."""


def usage(head: str, flags: Iterable[Flag], tail: str = "") -> str:
    """Return the help text: `head`, one line for each flag, `tail`."""
    lines = [f"  -{flag.name:<16} {flag.about}" for flag in flags]
    return "\n".join([head, *lines, *([tail] if tail else [])]) + "\n"


def read(arguments: Sequence[str], flags: Iterable[Flag]) -> dict[str, Any]:
    """Return the values of the given flags; for a repeated flag the last value."""
    known = {flag.name: flag for flag in flags}
    values: dict[str, Any] = {}
    waiting = list(arguments)
    while waiting:
        word = waiting.pop(0)
        name, equals, text = word.lstrip("-").partition("=")
        if not word.startswith("-") or word.strip("-") == "":
            raise UsageError(f"unexpected argument '{word}'; options start with - (see --help)")
        if name not in known and name.startswith("no") and getattr(known.get(name[2:]), "kind", "") == "switch":
            values[name[2:]] = False
            continue
        if name not in known:
            raise UsageError(f"there is no option '{word.partition('=')[0]}'{_nearest(word, known)}")
        flag = known[name]
        if equals:
            words = text.split() if flag.count > 1 else [text]
        elif flag.kind == "switch":
            words = [waiting.pop(0)] if waiting and waiting[0].lower() in _SWITCH else ["true"]
        else:
            words, waiting = waiting[: flag.count], waiting[flag.count :]
        if len(words) < flag.count:
            what = "a value" if flag.count == 1 else f"{flag.count} values"
            raise UsageError(f"-{name} needs {what} after it")
        read_words = [_value(flag, each, f"-{name}") for each in words]
        values[name] = read_words[0] if flag.count == 1 else read_words
    return values


def with_parameters(node: Node, values: dict[str, Any], flags: Iterable[Flag]) -> dict[str, Any]:
    """Return `values`, replaced by the node's parameters; an empty parameter counts as not given."""
    merged = dict(values)
    for flag in flags:
        if not flag.parameter or not node.has_parameter(flag.name):
            continue
        value = node.get_parameter(flag.name).value
        if value is None or value == "":
            continue
        text = ("true" if value else "false") if isinstance(value, bool) else str(value)
        merged[flag.name] = _value(flag, text, f"the parameter {flag.name}")
    return merged


def _value(flag: Flag, text: str, what: str) -> Any:
    if flag.kind == "switch":
        if text.lower() not in _SWITCH:
            raise UsageError(f"{what} must be true or false, got '{text}'")
        return _SWITCH[text.lower()]
    if flag.kind == "number":
        try:
            number = float(text)
        except ValueError:
            number = math.nan
        if not math.isfinite(number):
            raise UsageError(f"{what} must be a finite number, got '{text}'")
        return number
    if flag.kind == "whole":
        if not (text.isascii() and text.isdigit() and len(text) < 19):
            raise UsageError(f"{what} must be a whole number of 0 or more, got '{text}'")
        return int(text)
    return text


def _nearest(word: str, known: Iterable[str]) -> str:
    dashes = "--" if word.startswith("--") else "-"
    return did_you_mean(word.partition("=")[0], [dashes + name for name in known], listing="options are")
