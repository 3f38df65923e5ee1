"""The definition of a message type as one text, with those of all types in it.

Source: https://github.com/ros2/rosbag2, docs/message_definition_encoding.md (`ros2msg`), and rosbag2_cpp 0.26
(`local_message_definition_source.cpp`), which names the types without `msg`; https://mcap.dev/spec/registry
"""

from __future__ import annotations

import functools
import re
from collections.abc import Iterator
from pathlib import Path

from ament_index_python.packages import PackageNotFoundError, get_package_share_directory

SEPARATOR = "=" * 80
ENCODING = "ros2msg"
UNKNOWN = ("unknown", "")
"""Encoding and text of a definition that is not known."""
_PRIMITIVES = frozenset(
    ["bool", "byte", "char", "float32", "float64", "string", "wstring"]
    + [f"{sign}{bits}" for sign in ("int", "uint") for bits in (8, 16, 32, 64)]
)
_TYPE = re.compile(r"([A-Za-z]\w*)/(?:msg/)?([A-Za-z]\w*)")


@functools.cache
def definition(type_name: str) -> tuple[str, str]:
    """Return encoding and text of the definition of `package/msg/Name`, `UNKNOWN` if a part of it is missing."""
    texts: dict[str, str] = {}
    todo = [type_name]
    while todo:
        here = todo.pop(0)
        if here in texts:
            continue
        text = _text(here)
        if text is None:
            return UNKNOWN
        texts[here] = text
        todo += nested_types(text, here.partition("/")[0])
    first, *others = texts
    parts = [texts[first], *(f"{SEPARATOR}\nMSG: {_short(name)}\n{texts[name]}" for name in others)]
    return ENCODING, "\n".join(part.rstrip("\n") for part in parts) + "\n"


def _short(name: str) -> str:
    """Return `package/Name`: readers find the types of fields by the names that texts have."""
    return name.replace("/msg/", "/", 1)


def nested_types(text: str, package: str) -> Iterator[str]:
    """Yield the types of messages that are fields of a message with this text."""
    for line in text.splitlines():
        words = line.partition("#")[0].split()
        if len(words) < 2:
            continue
        name = words[0].partition("[")[0].partition("<")[0]
        if name in _PRIMITIVES:
            continue
        if found := _TYPE.fullmatch(name):
            yield f"{found[1]}/msg/{found[2]}"
        elif "/" not in name:
            yield f"{package}/msg/{name}"


def parts_of(name: str, text: str) -> dict[str, str]:
    """Return the text of each type in a whole definition of the type `name`, by `package/msg/Name`."""
    parts: dict[str, list[str]] = {name: []}
    here = name
    lines = iter(text.splitlines())
    for line in lines:
        if line.rstrip() == SEPARATOR:
            found = _TYPE.fullmatch(next(lines, "").removeprefix("MSG:").strip())
            here = f"{found[1]}/msg/{found[2]}" if found else ""
        parts.setdefault(here, []).append("" if line.rstrip() == SEPARATOR else line)
    return {each: "\n".join(lines) + "\n" for each, lines in parts.items() if each}


def _text(type_name: str) -> str | None:
    package, kind, name = ([*type_name.split("/"), "", ""])[:3]
    if kind != "msg":
        return None
    try:
        return Path(get_package_share_directory(package), kind, f"{name}.msg").read_text(encoding="utf-8")
    except (PackageNotFoundError, OSError, ValueError):
        return None
