"""Converts YAML, as an argument of `ros2 topic pub` and `ros2 service call`, to a ROS message.

The inverse of `message_text`: output of `ros2 topic echo` can be published again. A value is converted to the type of
its field, not guessed as in YAML: `data: yes` is a text for a string and true for a bool. Two words stand for the time
of sending: `now` for a `builtin_interfaces/Time`, `auto` for a `std_msgs/Header`.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import yaml
from rosidl_parser.definition import (
    AbstractNestedType,
    AbstractString,
    AbstractWString,
    Array,
    BasicType,
    BoundedSequence,
    NamespacedType,
)

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.ros2.errors import CommandError

_TIME, _HEADER = "builtin_interfaces/Time", "std_msgs/Header"
_LARGEST_FLOAT32 = 3.4028234663852886e38
_BITS = {f"{sign}int{bits}": (sign, bits) for sign in ("", "u") for bits in (8, 16, 32, 64)}
_TRUE, _FALSE = {"true", "yes", "on", "1"}, {"false", "no", "off", "0"}

Stamp = Callable[[Any], None]
"""A function that writes a builtin_interfaces/Time into one field of a message."""


def parse_yaml(text: str) -> yaml.Node | None:
    """Parse a text; return None if it is empty. Raises CommandError with the position if it is not YAML."""
    try:
        return yaml.compose(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = f"line {mark.line + 1}, column {mark.column + 1}: " if mark else ""
        raise CommandError(f"The passed value is not YAML: {place}{error.problem or error.context}") from None
    except (yaml.YAMLError, UnicodeError) as error:
        raise CommandError(f"The passed value is not YAML: {str(error).splitlines()[0]}") from None
    except RecursionError:
        raise CommandError("The passed value is not a message: it is nested too deeply") from None


def fill(message: Any, text: str) -> list[Stamp]:
    """Set the fields that a YAML text names; return the functions to call with the time of each sending.

    Raises CommandError if the text is no YAML, no mapping, or does not fit the message.
    """
    document = parse_yaml(text)
    stamps: list[Stamp] = []
    if document is None:
        return stamps
    if not isinstance(document, yaml.MappingNode):
        raise CommandError(
            "The passed value needs to be a dictionary in YAML format, e.g. "
            f"'{next(iter(message.get_fields_and_field_types()), 'field')}: ...'; it is {_what(document)}"
        )
    try:
        _fill(message, document, _Place(type(message).__name__), stamps)
    except RecursionError:
        raise CommandError("The passed value is not a message: it is nested too deeply") from None
    return stamps


@dataclass(frozen=True)
class _Place:
    """A place in a message for errors: the type name and the path of the field."""

    kind: str
    path: str = ""

    def __truediv__(self, name: str) -> _Place:
        return _Place(self.kind, f"{self.path}.{name}" if self.path else name)

    def __getitem__(self, index: int) -> _Place:
        return _Place(self.kind, f"{self.path}[{index}]")

    def refuse(self, sentence: str) -> CommandError:
        return CommandError(f"Failed to populate field: {sentence}")

    def wants(self, wanted: str, node: yaml.Node) -> CommandError:
        return self.refuse(f"'{self.path}' of {self.kind} is {wanted}, not {_what(node)}")


def _what(node: yaml.Node) -> str:
    """Return a value as the user wrote it, or its kind if it is long."""
    if isinstance(node, yaml.MappingNode):
        return "a dictionary"
    if isinstance(node, yaml.SequenceNode):
        return "a list"
    text = str(node.value)
    return repr(text if len(text) <= 40 else text[:40] + "...") if text else "empty"


def _fill(message: Any, node: yaml.MappingNode, place: _Place, stamps: list[Stamp]) -> None:
    kinds = dict(zip(message.get_fields_and_field_types(), message.SLOT_TYPES, strict=True))
    for key, value in node.value:
        name = str(key.value)
        if name not in kinds:
            owner = f"'{place.path}' of {place.kind}" if place.path else place.kind
            known = ", ".join(kinds) or "none"
            raise place.refuse(f"{owner} has no field '{name}', its fields: {known}{did_you_mean(name, kinds)}")
        _set(message, name, kinds[name], value, place / name, stamps)


def _set(message: Any, name: str, kind: Any, node: yaml.Node, place: _Place, stamps: list[Stamp]) -> None:
    if isinstance(kind, NamespacedType):
        if isinstance(node, yaml.ScalarNode) and (stamp := _stamp(message, name, kind, node.value)):
            stamps.append(stamp)
        else:
            _fill(getattr(message, name), _mapping(kind, node, place), place, stamps)
        return
    value = _list(kind, node, place, stamps) if isinstance(kind, AbstractNestedType) else _scalar(kind, node, place)
    try:
        setattr(message, name, value)
    except (AssertionError, ValueError, TypeError, OverflowError) as error:
        raise place.refuse(f"'{place.path}' of {place.kind}: {error}") from None


def _stamp(message: Any, name: str, kind: NamespacedType, word: str) -> Stamp | None:
    full = f"{kind.namespaces[0]}/{kind.name}"
    if full == _TIME and word == "now":
        return lambda time: setattr(message, name, time)
    if full == _HEADER and word == "auto":
        return lambda time: setattr(getattr(message, name), "stamp", time)
    return None


def _mapping(kind: NamespacedType, node: yaml.Node, place: _Place) -> yaml.MappingNode:
    if not isinstance(node, yaml.MappingNode):
        raise place.wants(f"a {kind.namespaces[0]}/{kind.name}: a dictionary", node)
    return node


def _list(kind: Any, node: yaml.Node, place: _Place, stamps: list[Stamp]) -> list[Any]:
    if not isinstance(node, yaml.SequenceNode):
        raise place.wants("a list", node)
    items = node.value
    cut = items and isinstance(items[-1], yaml.ScalarNode) and items[-1].value == "..."
    if cut and not isinstance(kind.value_type, AbstractString | AbstractWString):
        raise place.refuse(f"'{place.path}' ends in '...': echo has left items out; use ros2 topic echo --full-length")
    if isinstance(kind, Array) and len(items) != kind.size:
        raise place.refuse(f"'{place.path}' of {place.kind} has {kind.size} items, not {len(items)}")
    if isinstance(kind, BoundedSequence) and len(items) > kind.maximum_size:
        raise place.refuse(f"'{place.path}' of {place.kind} has at most {kind.maximum_size} items, not {len(items)}")
    return list(_items(kind.value_type, items, place, stamps))


def _items(kind: Any, items: list[yaml.Node], place: _Place, stamps: list[Stamp]) -> Iterator[Any]:
    if not isinstance(kind, NamespacedType):
        yield from (_scalar(kind, item, place) for item in items)
        return
    cls = getattr(importlib.import_module(".".join(kind.namespaces)), kind.name)
    for index, item in enumerate(items):
        message = cls()
        _fill(message, _mapping(kind, item, place[index]), place[index], stamps)
        yield message


def _scalar(kind: Any, node: yaml.Node, place: _Place) -> Any:
    if isinstance(kind, AbstractString | AbstractWString):
        if not isinstance(node, yaml.ScalarNode):
            raise place.wants("a string", node)
        longest = getattr(kind, "maximum_size", None)
        if longest is not None and len(node.value) > longest:
            raise place.refuse(f"'{place.path}' of {place.kind} has at most {longest} characters")
        return node.value
    assert isinstance(kind, BasicType)
    name = kind.typename
    if not isinstance(node, yaml.ScalarNode):
        raise place.wants(f"a {name}", node)
    if name == "boolean":
        return _bool(node, place)
    if name in ("float", "double", "long double"):
        return _float(node, name, place)
    if name == "octet":
        return _byte(node, place)
    sign, bits = _BITS.get(name, ("u", 8))  # a char of ROS 2 is a uint8
    lowest, highest = (0, 2**bits - 1) if sign else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
    return _int(node, name, lowest, highest, place)


def _bool(node: yaml.ScalarNode, place: _Place) -> bool:
    word = str(node.value).lower()
    if word not in _TRUE | _FALSE:
        raise place.wants("a boolean (true or false)", node)
    return word in _TRUE


def _float(node: yaml.ScalarNode, name: str, place: _Place) -> float:
    text = str(node.value)
    try:
        # YAML writes .inf and .nan; Python's words for them are accepted, too.
        value = float(text.replace(".inf", "inf").replace(".Inf", "inf").replace(".nan", "nan").replace(".NaN", "nan"))
    except ValueError:
        raise place.wants(f"a {name}", node) from None
    if name == "float" and _LARGEST_FLOAT32 < abs(value) < float("inf"):
        raise place.wants("a float of 32 bits", node)
    return value


def _byte(node: yaml.ScalarNode, place: _Place) -> bytes:
    text = str(node.value)
    if not node.style and text.isascii() and text.isdigit() and int(text) < 256:
        return bytes([int(text)])
    if len(text) == 1 and ord(text) < 256:
        return text.encode("latin-1")
    raise place.wants("a byte: a character or a number from 0 to 255", node)


def _int(node: yaml.ScalarNode, name: str, lowest: int, highest: int, place: _Place) -> int:
    text = str(node.value)
    try:
        value = int(text) if text.lstrip("+-").isdecimal() else int(text, 0)
    except ValueError:
        try:
            whole = float(text)  # 1e3 and 2.0 are whole numbers, too
            value = int(whole)
        except (ValueError, OverflowError):
            raise place.wants(f"a whole number ({name})", node) from None
        if value != whole:
            raise place.wants(f"a whole number ({name})", node) from None
    if not lowest <= value <= highest:
        raise place.wants(f"a number from {lowest} to {highest} ({name})", node)
    return value
