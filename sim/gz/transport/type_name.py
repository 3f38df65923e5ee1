"""Names of message types: conversion from classes and to the spelling of Fortress."""

from __future__ import annotations

from google.protobuf.message import Message

_PACKAGE, _FORTRESS_PACKAGE = "gz.msgs.", "ignition.msgs."


def type_name(message_type: type[Message] | str) -> str:
    """Return the name of a message class, or a given name unchanged. Raises TypeError for anything else."""
    if isinstance(message_type, str):
        return message_type
    if isinstance(message_type, type) and issubclass(message_type, Message):
        return str(message_type.DESCRIPTOR.full_name)
    raise TypeError(
        f"Expected a message class such as gz.msgs.twist_pb2.Twist or a type name such as 'gz.msgs.Twist', "
        f"but was given {message_type!r}."
    )


def for_fortress(name: str) -> str:
    """Return the name of the type in Fortress: `ignition.msgs.Twist`."""
    return _FORTRESS_PACKAGE + name.removeprefix(_PACKAGE) if name.startswith(_PACKAGE) else name
