"""The fields of the messages of a run, which the looks into a student's Python ask for."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from gz_course.grader.errors import ManifestError
from gz_course.grader.run.grader_endpoints import message_class

FLOATS = frozenset({"float", "double"})


def message_fields(ros_types: Iterable[str]) -> dict[str, list[str]]:
    """Return the fields of message types and of their parts, by class; a type that is not installed is left out."""
    found: dict[str, list[str]] = {}
    waiting = list(ros_types)
    while waiting:
        try:
            message = message_class(waiting.pop())
        except ManifestError:
            continue  # reported when the bridge is made
        fields = message.get_fields_and_field_types()
        found[message.__name__] = list(fields)
        for kind in fields.values():
            package, slash, name = kind.partition("/")
            if slash and not kind.endswith("]") and not kind.startswith("sequence<") and name not in found:
                waiting.append(f"{package}/msg/{name}")
    return found


def float_fields(ros_types: Iterable[str]) -> dict[str, set[str]]:
    """Return the fields of message types that hold one floating-point number, grouped by the class that owns them.

    Keys are the names of a message and of its parts: {"Twist": {"linear.x", ...}, "Vector3": {"x", "y", "z"}}. A type
    that is not installed is left out.
    """
    found: dict[str, set[str]] = {}
    for name in ros_types:
        try:
            _walk(message_class(name), found)
        except ManifestError:
            continue  # reported when the bridge is made
    return found


def _walk(message: Any, found: dict[str, set[str]]) -> set[str]:
    paths = set()
    for field, kind in message.get_fields_and_field_types().items():
        if kind in FLOATS:
            paths.add(field)
        elif "/" in kind and not kind.endswith("]") and not kind.startswith("sequence<"):
            package, _, name = kind.partition("/")
            paths |= {f"{field}.{path}" for path in _walk(message_class(f"{package}/msg/{name}"), found)}
    found[message.__name__] = paths
    return paths
