"""Sets the fields of a message from a dictionary, as it comes from YAML.

Source: ros2/rosidl_runtime_py, rosidl_runtime_py/set_message.py
"""

from __future__ import annotations

import array
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np
from rosidl_parser.definition import AbstractNestedType, NamespacedType

from gz_course.sim.ros.rosidl_runtime_py.convert import get_message_slot_types
from gz_course.sim.ros.rosidl_runtime_py.import_message import import_message_from_namespaced_type

Setter = Callable[[Any], None]


def set_message_fields(
    msg: Any, values: Mapping[str, Any], expand_header_auto: bool = False, expand_time_now: bool = False
) -> list[Setter]:
    """Set the fields that `values` names; return functions that take the time of sending.

    With `expand_header_auto` the value `auto` of a Header, with `expand_time_now` the value `now` of a Time adds such a
    function. Raises AttributeError for a field that the message does not have, TypeError for a value of another type.
    """
    words = {"Header": "auto"} if expand_header_auto else {}
    words |= {"Time": "now"} if expand_time_now else {}
    setters: list[Setter] = []
    _set_fields(msg, values, words, setters)
    return setters


def _set_fields(message: Any, values: Mapping[str, Any], words: Mapping[str, str], setters: list[Setter]) -> None:
    if not isinstance(values, Mapping):
        raise TypeError(f"Value '{values}' is expected to be a dictionary but is a {type(values).__name__}")
    types = get_message_slot_types(message)
    for name, value in values.items():
        kind, field = types.get(name), getattr(message, name)
        if isinstance(kind, NamespacedType):
            if words.get(kind.name) == value and isinstance(value, str):
                setters.append(partial(setattr, *((message, name) if kind.name == "Time" else (field, "stamp"))))
            elif isinstance(value, type(field)):
                setattr(message, name, value)
            else:
                _set_fields(field, value, words, setters)
        elif isinstance(kind, AbstractNestedType) and isinstance(kind.value_type, NamespacedType):
            setattr(message, name, [_made(kind.value_type, each, words, setters) for each in value])
        elif isinstance(field, array.array):
            setattr(message, name, array.array(field.typecode, value))
        elif isinstance(field, np.ndarray):
            setattr(message, name, np.array(value, dtype=field.dtype))
        else:
            setattr(message, name, value if isinstance(value, type(field)) else type(field)(value))


def _made(kind: NamespacedType, value: Any, words: Mapping[str, str], setters: list[Setter]) -> Any:
    made = import_message_from_namespaced_type(kind)
    if isinstance(value, made):
        return value
    message = made()
    _set_fields(message, value, words, setters)
    return message
