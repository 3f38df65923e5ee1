"""A ROS message as a dictionary, as YAML or as one line of CSV; fields are in the order of their definition.

Lists and texts that are longer than `truncate_length` are cut and end in `...`; `no_arr` and `no_str` write what a list
or a text is instead of what it holds.

Source: ros2/rosidl_runtime_py, rosidl_runtime_py/convert.py
"""

from __future__ import annotations

import array
import sys
from collections import OrderedDict
from collections.abc import Iterator
from typing import Any

import numpy as np
import yaml
from rosidl_parser.definition import (
    AbstractString,
    AbstractWString,
    Array,
    BasicType,
    BoundedSequence,
    NamedType,
    NamespacedType,
)

_SEQUENCES = (list, tuple, array.array, np.ndarray)


class MessageDumper(yaml.SafeDumper):
    """A dumper that writes shared values in full instead of as aliases."""

    def ignore_aliases(self, data: Any) -> bool:
        return True


def _text(dumper: yaml.SafeDumper, text: str) -> yaml.ScalarNode:
    # YAML folds these line breaks, unless they are escaped in double quotes.
    style = '"' if any(mark in text for mark in "\x85\u2028\u2029") else None
    return dumper.represent_scalar("tag:yaml.org,2002:str", text, style=style)


MessageDumper.add_representer(str, _text)
MessageDumper.add_representer(OrderedDict, yaml.SafeDumper.represent_dict)


def message_to_ordereddict(
    msg: Any, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False
) -> OrderedDict[str, Any]:
    """Return the fields of a message as dictionaries, lists and plain values."""
    types = get_message_slot_types(msg).items()
    return OrderedDict(
        (name, _plain(getattr(msg, name), kind, truncate_length, no_arr, no_str)) for name, kind in types
    )


def message_to_yaml(
    msg: Any,
    *,
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
    flow_style: bool | None = False,
) -> str:
    """Return the message as YAML, ending in a line break."""
    fields = message_to_ordereddict(msg, truncate_length=truncate_length, no_arr=no_arr, no_str=no_str)
    text: str = yaml.dump(
        fields,
        Dumper=MessageDumper,
        sort_keys=False,
        allow_unicode=True,
        width=sys.maxsize,
        default_flow_style=flow_style,
    )
    return text


def message_to_csv(msg: Any, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False) -> str:
    """Return all values of the message in one line, separated by commas."""
    fields = message_to_ordereddict(msg, truncate_length=truncate_length, no_arr=no_arr, no_str=no_str)
    return ",".join(_values(fields))


def get_message_slot_types(msg: Any) -> OrderedDict[str, Any]:
    """Return the type of each field, as an object of `rosidl_parser.definition`."""
    return OrderedDict(zip(msg.get_fields_and_field_types(), msg.SLOT_TYPES, strict=True))


def _plain(value: Any, kind: Any, limit: int | None, no_arr: bool, no_str: bool) -> Any:
    """Return the value of a field in Python's own types; `kind` is the field's type."""
    if hasattr(value, "get_fields_and_field_types"):
        return message_to_ordereddict(value, truncate_length=limit, no_arr=no_arr, no_str=no_str)
    if isinstance(value, bytes):
        value = value.decode("latin-1")
    elif isinstance(value, str) and no_str:
        return f"<string length: <{len(value)}>>"
    if isinstance(value, str):
        return value if limit is None or len(value) <= limit else value[:limit] + "..."
    if isinstance(value, _SEQUENCES):
        if no_arr:
            return _described(value, kind)
        shown = value if limit is None else value[:limit]
        items = [_plain(item, kind.value_type, limit, no_arr, no_str) for item in shown]
        return items if len(shown) == len(value) else [*items, "..."]
    return value.item() if isinstance(value, np.generic) else value


def _described(value: Any, kind: Any) -> str:
    item = _type_name(kind.value_type)
    if isinstance(kind, Array):
        return f"<array type: {item}[{kind.size}]>"
    bound = f"[{kind.maximum_size}]" if isinstance(kind, BoundedSequence) else ""
    return f"<sequence type: {item}{bound}, length: {len(value)}>"


def _type_name(kind: Any) -> str:
    if isinstance(kind, AbstractString | AbstractWString):
        return "string" if isinstance(kind, AbstractString) else "wstring"
    if isinstance(kind, BasicType):
        return str(kind.typename)
    if isinstance(kind, NamespacedType):
        return "/".join(kind.namespaced_name())
    return str(kind.name) if isinstance(kind, NamedType) else "unknown"


def _values(value: Any) -> Iterator[str]:
    if isinstance(value, dict):
        for item in value.values():
            yield from _values(item)
    elif isinstance(value, list):
        for item in value:
            yield from _values(item)
    else:
        yield str(value)
