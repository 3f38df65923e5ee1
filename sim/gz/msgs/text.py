"""Messages as text: the output of `gz topic -e` and the input of `gz topic -p`.

to_text() and to_json_line() write, from_text() reads protobuf's text format. The output equals that of Gazebo's own
tools (DebugString and the JSON writer of C++ protobuf) byte for byte, so that scripts can read both.

Source: https://protobuf.dev/reference/protobuf/textformat-spec/
Source: https://protobuf.dev/programming-guides/json/
"""

from __future__ import annotations

import base64
import json
import math
import re
import struct
from collections.abc import Iterator
from typing import Any, TypeVar

from google.protobuf.descriptor import FieldDescriptor
from google.protobuf.message import Message

from gz_course.sim.did_you_mean import did_you_mean

AnyMessage = TypeVar("AnyMessage", bound=Message)

_OCTAL = {code: f"\\{code:03o}" for code in (*range(0x20), *range(0x7F, 0x100))} | {
    ord(character): "\\" + letter for character, letter in zip("\n\r\t\"'\\", "nrt\"'\\", strict=True)
}
_SMALLEST_NORMAL_SINGLE = 2.0**-126
_JSON_NAMES = {"nan": "NaN", "inf": "Infinity", "-inf": "-Infinity"}
_POSITION = re.compile(r"^(\d+):(\d+) : (.*)$", re.DOTALL)
_NO_FIELD = re.compile(r'Message type "([\w.]+)" has no field named "([^"]*)"')
_ANGLE_BRACKETS = {ord("<"): "\\u003c", ord(">"): "\\u003e"}
_INVISIBLE = re.compile(
    "[\x7f-\x9f\xad\u0600-\u0603\u06dd\u070f\u17b4\u17b5\u200b-\u200f\u2028-\u202e\u2060-\u2064\u206a-\u206f"
    "\ufeff\ufff9-\ufffb\U0001d173-\U0001d17a\U000e0001\U000e0020-\U000e007f]"
)
"""Control and formatting characters that the C++ JSON writer escapes although JSON does not require it."""
_LONG_INTEGERS = (
    FieldDescriptor.CPPTYPE_INT64,
    FieldDescriptor.CPPTYPE_UINT64,
)


class MessageTextError(ValueError):
    """A text that is no message of the expected type; the error names the position and what was expected."""


def to_text(message: Message) -> str:
    """Return a message in protobuf's text format, indented by two spaces, ending with a newline unless empty."""
    return "".join(_lines(message, ""))


def _lines(message: Message, indent: str) -> Iterator[str]:
    for field, value in message.ListFields():
        entry = field.message_type
        if entry is not None and entry.GetOptions().map_entry:
            inside = indent + "  "
            for key in sorted(value):
                yield f"{indent}{field.name} {{\n"
                yield from _field_lines(entry.fields_by_name["key"], key, inside)
                yield from _field_lines(entry.fields_by_name["value"], value[key], inside)
                yield f"{indent}}}\n"
        elif field.is_repeated:
            for each in value:
                yield from _field_lines(field, each, indent)
        else:
            yield from _field_lines(field, value, indent)


def _field_lines(field: FieldDescriptor, value: Any, indent: str) -> Iterator[str]:
    if isinstance(value, Message):
        yield f"{indent}{field.name} {{\n"
        yield from _lines(value, indent + "  ")
        yield f"{indent}}}\n"
    else:
        yield f"{indent}{field.name}: {_scalar(field, value)}\n"


def _scalar(field: FieldDescriptor, value: Any) -> str:
    if isinstance(value, float):
        return _number(value, field.cpp_type == FieldDescriptor.CPPTYPE_FLOAT)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        value = value.encode()
    if isinstance(value, bytes):
        return f'"{value.decode("latin-1").translate(_OCTAL)}"'
    if field.enum_type is not None:
        return _enum_name(field, value)
    return str(value)


def _enum_name(field: FieldDescriptor, value: int) -> str:
    known = field.enum_type.values_by_number.get(value) if field.enum_type is not None else None
    return str(known.name if known is not None else value)


def _number(value: float, single: bool) -> str:
    """Return a number in the shorter of two precisions that reads back as the same number, as C++ protobuf does."""
    if not math.isfinite(value):
        return "nan" if math.isnan(value) else "inf" if value > 0 else "-inf"
    short, long = ("%.6g", "%.9g") if single else ("%.15g", "%.17g")
    text = short % value
    if single:  # the C library reports an underflow as an error, so that the C++ writer takes the long form
        same = _as_single(float(text)) == value and (value == 0.0 or abs(value) >= _SMALLEST_NORMAL_SINGLE)
    else:
        same = float(text) == value
    return text if same else long % value


def _as_single(value: float) -> float:
    try:
        return struct.unpack("f", struct.pack("f", value))[0]
    except OverflowError:  # rounds to more than the largest float32
        return math.inf


def from_text(text: str, message_class: type[AnyMessage]) -> AnyMessage:
    """Parse the message in a text such as `linear: {x: 0.5}, angular: {z: 0.2}`.

    Raises MessageTextError: one sentence with line and column and, for an unknown field, the nearest name.
    """
    from google.protobuf import text_format

    message = message_class()
    try:
        text_format.Parse(text, message)
    except text_format.ParseError as error:
        raise MessageTextError(_explained(str(error), message)) from None
    except (ValueError, RecursionError) as error:
        raise MessageTextError(f"{text[:60]!r} is no {message.DESCRIPTOR.full_name}: {error}") from None
    return message


def _explained(error: str, message: Message) -> str:
    where, what = "", error
    if found := _POSITION.match(error):
        where, what = f" at line {found.group(1)}, column {found.group(2)}", found.group(3)
    what = what.rpartition("': ")[2] if what.startswith("'") else what
    if unknown := _NO_FIELD.search(what):
        owner, name = unknown.groups()
        fields = _fields_of(message.DESCRIPTOR, owner)
        hint = did_you_mean(name, fields, cutoff=0.5) or f"; its fields are {', '.join(fields)}."
        return f"The text is no {message.DESCRIPTOR.full_name}{where}: {owner} has no field {name!r}{hint}"
    return f"The text is no {message.DESCRIPTOR.full_name}{where}: {' '.join(what.split()).rstrip('.')}."


def _fields_of(start: object, full_name: str) -> list[str]:
    """Return the field names of a message type that is reachable from `start`."""
    todo, seen = [start], set()
    while todo:
        descriptor = todo.pop()
        if descriptor.full_name == full_name:  # type: ignore[attr-defined]
            return [field.name for field in descriptor.fields]  # type: ignore[attr-defined]
        seen.add(descriptor.full_name)  # type: ignore[attr-defined]
        for field in descriptor.fields:  # type: ignore[attr-defined]
            if field.message_type is not None and field.message_type.full_name not in seen:
                todo.append(field.message_type)
    return []


def to_json_line(message: Message) -> str:
    """Return a message as one line of JSON without spaces.

    Names are in lowerCamelCase, fields with default values are omitted, 64-bit integers and infinities are strings,
    bytes are in base64.
    """
    return (
        "{" + ",".join(f'"{field.json_name}":{_json_of(field, value)}' for field, value in message.ListFields()) + "}"
    )


def _json_of(field: FieldDescriptor, value: Any) -> str:
    if field.message_type is not None and field.message_type.GetOptions().map_entry:
        entries = field.message_type.fields_by_name
        pairs = sorted(value.items())
        return "{" + ",".join(f"{_json_key(k)}:{_json_value(entries['value'], v)}" for k, v in pairs) + "}"
    if field.is_repeated:
        return "[" + ",".join(_json_value(field, each) for each in value) + "]"
    return _json_value(field, value)


def _json_key(key: object) -> str:
    return _json_string(str(key).lower() if isinstance(key, bool) else str(key))


def _json_value(field: FieldDescriptor, value: Any) -> str:
    if isinstance(value, Message):
        return to_json_line(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, bytes):
        return f'"{base64.b64encode(value).decode()}"'
    if isinstance(value, str):
        return _json_string(value)
    if isinstance(value, float):
        return _json_number(value, field.cpp_type == FieldDescriptor.CPPTYPE_FLOAT)
    if field.enum_type is not None:
        name = _enum_name(field, value)
        return f'"{name}"' if not name.lstrip("-").isdigit() else name
    return f'"{value}"' if field.cpp_type in _LONG_INTEGERS else str(value)


def _json_string(text: str) -> str:
    return _INVISIBLE.sub(
        lambda found: json.dumps(found.group())[1:-1], json.dumps(text, ensure_ascii=False)
    ).translate(_ANGLE_BRACKETS)


def _json_number(value: float, single: bool) -> str:
    text = _number(value, single)
    return f'"{_JSON_NAMES[text]}"' if text in _JSON_NAMES else text
