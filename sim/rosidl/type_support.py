"""Gives a class made at run time its type support, when rclpy first asks for it."""

from __future__ import annotations

import functools
from typing import Any

from gz_course.sim.rosidl.definitions import description
from gz_course.sim.rosidl.described_type import DescribedType
from gz_course.sim.rosidl.message_type_support import MessageSupport


def add_message_support(message_class: Any) -> None:
    """Set the capsules of a message class."""
    for name, value in message_support(message_class).capsules().items():
        setattr(type(message_class), name, value)


@functools.cache
def message_support(message_class: Any) -> MessageSupport:
    """Return the type support of a message class; there is one for each class."""
    package, kind, _ = message_class.__module__.split(".")
    return MessageSupport(message_class, DescribedType(description(f"{package}/{kind}/{message_class.__name__}")))
