"""Message definitions as text: the output of `gz msg --info TYPE`.

The layout is that of C++ protobuf: nested types first, full type names with a leading dot, two spaces of indentation.

Source: https://github.com/protocolbuffers/protobuf/blob/main/src/google/protobuf/descriptor.cc (DebugString)
"""

from __future__ import annotations

from typing import Any

from google.protobuf.message import Message

from gz_course.sim.gz.msgs.proto_reader import SCALARS

_KINDS = {number: name for name, number in SCALARS.items()}


def describe(message_class: type[Message]) -> str:
    """Return name, file and definition of a message type, ending with an empty line."""
    descriptor = message_class.DESCRIPTOR
    definition = "\n".join(_message(descriptor, 0))
    return f"Name: {descriptor.full_name}\nFile: {descriptor.file.name}\n\n{definition}\n\n"


def _message(descriptor: Any, depth: int) -> list[str]:
    pad, lines = "  " * depth, []
    for nested in descriptor.nested_types:
        if not nested.GetOptions().map_entry:
            lines += _message(nested, depth + 1)
    for enum in descriptor.enum_types:
        lines += _enum(enum, depth + 1)
    for field in descriptor.fields:
        oneof = field.containing_oneof
        if oneof is None:
            lines.append(_field(field, depth + 1))
        elif oneof.fields[0] is field or oneof.fields[0].number == field.number:
            lines.append(f"{pad}  oneof {oneof.name} {{")
            lines += [_field(each, depth + 2) for each in oneof.fields]
            lines.append(f"{pad}  }}")
    return [f"{pad}message {descriptor.name} {{", *lines, f"{pad}}}"]


def _enum(descriptor: Any, depth: int) -> list[str]:
    pad = "  " * depth
    values = [f"{pad}  {value.name} = {value.number};" for value in descriptor.values]
    return [f"{pad}enum {descriptor.name} {{", *values, f"{pad}}}"]


def _field(field: Any, depth: int) -> str:
    label = ""
    if field.message_type is not None and field.message_type.GetOptions().map_entry:
        entry = field.message_type.fields_by_name
        kind = f"map<{_kind(entry['key'])}, {_kind(entry['value'])}>"
    else:
        kind = _kind(field)
        if field.is_repeated:
            label = "repeated "
    options = field.GetOptions()
    packed = f" [packed = {str(options.packed).lower()}]" if options.HasField("packed") else ""
    return f"{'  ' * depth}{label}{kind} {field.name} = {field.number}{packed};"


def _kind(field: Any) -> str:
    if field.message_type is not None:
        return f".{field.message_type.full_name}"
    if field.enum_type is not None:
        return f".{field.enum_type.full_name}"
    return _KINDS[field.type]
