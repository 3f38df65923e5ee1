"""A new ROS message with every field at its default, made faster than by its constructor.

The constructor that ROS generates for a Python message imports the types of its parts, creates each part, looks up
every field among its arguments and calls its setter, each time. `blank` inspects one constructed message of a class and
then copies it: immutable values are shared, others are created anew. The conversions in `convert/` fill what it
returns.
"""

from __future__ import annotations

from array import array
from collections.abc import Callable
from typing import Any, TypeVar, cast

import numpy as np

Message = TypeVar("Message")

_UNCHANGEABLE = (bool, int, float, str, bytes)
_makers: dict[type, Callable[[], Any]] = {}


def blank(message_class: type[Message]) -> Message:
    """Return a message equal to `message_class()`; it shares no mutable value with another message."""
    maker = _makers.get(message_class)
    if maker is None:
        maker = _makers[message_class] = _maker(message_class)
    return cast(Message, maker())


def _maker(message_class: type) -> Callable[[], Any]:
    """Return a function that makes such messages: the constructor itself if the type of a field is not supported."""
    model = message_class()
    shared: list[tuple[str, Any]] = []
    renewed: list[tuple[str, Callable[[], Any]]] = []
    for slot in message_class.__slots__:  # type: ignore[attr-defined]
        value = getattr(model, slot)
        if isinstance(value, _UNCHANGEABLE):
            shared.append((slot, value))
        elif isinstance(value, array):
            renewed.append((slot, value.__copy__))
        elif isinstance(value, np.ndarray):
            renewed.append((slot, value.copy))
        elif value == []:
            renewed.append((slot, list))
        elif hasattr(value, "get_fields_and_field_types"):
            renewed.append((slot, _maker(type(value))))
        else:
            return message_class

    def make() -> Any:
        message: Any = object.__new__(message_class)
        for slot, value in shared:
            setattr(message, slot, value)
        for slot, make_value in renewed:
            setattr(message, slot, make_value())
        return message

    return make
