"""Generates what writes a message as bytes: the CDR encoding of ROS 2 messages (XCDR version 1).

For each message class a function is generated that holds all fields of the message, and of the messages in it, in one
piece. Neighbouring fields of fixed size are one `struct.Struct`; arrays of numbers are copied as a whole.

Offsets count from the first byte after the encapsulation header. A number is aligned to its own size, a text is its
length with the ending zero, its bytes and the zero; a sequence is its length and its elements.

Source: OMG DDS-XTypes 1.3, chapter 7.4.1, https://www.omg.org/spec/DDS-XTYPES/1.3
Source: Fast CDR 2.2 (a wide text has no ending zero, and four bytes for each unit of UTF-16)
"""

from __future__ import annotations

import array
import functools
import struct
import sys
from collections.abc import Callable
from typing import Any

from rosidl_parser import definition as idl

from gz_course.sim.ros.rosidl.cdr_code import Code
from gz_course.sim.ros.rosidl.cdr_layout import FORMATS, Run
from gz_course.sim.ros.rosidl.field_checks import is_number_array
from gz_course.sim.ros.rosidl.nested_classes import nested_class

Encode = Callable[[Any], bytes]


_EXACT = {"float": "float", "double": "float", "boolean": "bool"}
NATIVE_UTF_16 = f"utf-16-{sys.byteorder[0]}e"


@functools.cache
def encoder(message_class: type) -> Encode:
    """Return the function that writes a message. It raises what a wrong value in a field causes."""
    code = Code(
        {
            "join": b"".join,
            "tobytes": _tobytes,
            "octets": _octets,
            "zero_ended": _zero_ended,
            "units": _units,
            "fits": _fits,
            "exactly": _exactly,
        }
    )
    _Writer(code).write(message_class, "m")
    return code.function("m", ["parts = []", "p = parts.append", "n = 0"], "return join(parts)")


def _zero_ended(text: str) -> bytes:
    """Return the bytes of a text, which ends at its first zero as in C."""
    return (text.encode() + b"\0").partition(b"\0")[0] + b"\0"


def _units(text: str) -> bytes:
    """Return the units of UTF-16 of a wide text, four bytes each."""
    return array.array("I", array.array("H", text.encode(NATIVE_UTF_16))).tobytes()


def _tobytes(value: Any, size: int) -> bytes:
    if value.size != size:
        raise ValueError(f"expected {size} elements, found {value.size}")
    return value.tobytes()


def _octets(values: Any) -> bytes:
    data = b"".join(values)
    if len(data) != len(values):
        raise ValueError("each element of an array of byte must be of type 'bytes' with length 1")
    return data


def _fits(length: int, size: int | None, most: int | None) -> int:
    if (size is not None and length != size) or (most is not None and length > most):
        raise ValueError(f"expected {f'at most {most}' if size is None else size} elements, found {length}")
    return length


def _exactly(kind: type, *values: Any) -> None:
    """Refuse values of another type, which compiled packages send as wrong values or end the process for."""
    for value in values:
        if not isinstance(value, kind):
            raise TypeError(f"expected a value of type '{kind.__name__}', found {value!r}")


class _Writer:
    """Generates the code that writes a message; `n` is the offset, `p` appends bytes to the result."""

    def __init__(self, code: Code) -> None:
        self._code = code
        self._run = Run()
        self._exact: dict[str, list[str]] = {"float": [], "bool": []}

    def write(self, message_class: Any, message: str) -> None:
        self._message(message_class, message)
        self._flush()

    def _message(self, message_class: Any, message: str) -> None:
        if not message_class.SLOT_TYPES:
            self._run.add("x", "")
        for slot, kind in zip(message_class.__slots__, message_class.SLOT_TYPES, strict=False):
            self._field(kind, f"{message}.{slot}")

    def _field(self, kind: Any, value: str) -> None:
        if isinstance(kind, idl.AbstractNestedType):
            self._elements(kind, value)
        elif isinstance(kind, idl.BasicType):
            if kind.typename in _EXACT:
                value = self._named(value)
                self._exact[_EXACT[kind.typename]].append(value)
            self._run.add(FORMATS[kind.typename], value)
        elif isinstance(kind, idl.NamespacedType):
            self._message(nested_class(kind), self._named(value))
        else:
            wide = isinstance(kind, idl.AbstractWString)
            data = self._named(f"units({value})" if wide else f"zero_ended({value})")
            self._run.add("I", f"len({data}) >> 2" if wide else f"len({data})")
            self._bytes(data)

    def _elements(self, kind: Any, value: str) -> None:
        inner, values = kind.value_type, self._named(value)
        size, most = getattr(kind, "size", None), getattr(kind, "maximum_size", None)
        if is_number_array(kind) and size is not None:
            self._flush()
            self._number_data(inner, self._named(f"tobytes({values}, {size})"), 1)
            return
        counted = f"len({values})" if size is most is None else f"fits(len({values}), {size}, {most})"
        if size is None:
            self._run.add("I", counted)
        else:
            self._code.add(counted)
        if isinstance(inner, idl.BasicType):
            if is_number_array(kind):
                self._flush()
                self._number_data(inner, values, struct.calcsize(FORMATS[inner.typename]))
            else:
                self._bytes(
                    self._named(f"octets({values})" if inner.typename == "octet" else f"bytes(map(bool, {values}))")
                )
            return
        self._flush()
        element = self._code.local()
        self._code.block(f"for {element} in {values}:")
        self._field(inner, element)
        self._flush()
        self._code.end()

    def _number_data(self, inner: idl.BasicType, data: str, width: int) -> None:
        """Write an array of numbers, aligned unless it is empty; `data` has elements of `width` bytes."""
        alignment = struct.calcsize(FORMATS[inner.typename])
        self._code.block(f"if len({data}):")
        if alignment > 1:
            self._code.block(f"if n & {alignment - 1}:")
            self._code.add(f"p(bytes(-n & {alignment - 1}))")
            self._code.add(f"n += -n & {alignment - 1}")
            self._code.end()
        self._code.add(f"p({data})")
        self._code.add(f"n += len({data}) * {width}")
        self._code.end()

    def _bytes(self, data: str) -> None:
        self._flush()
        self._code.add(f"p({data})")
        self._code.add(f"n += len({data})")

    def _named(self, expression: str) -> str:
        name = self._code.local()
        self._code.add(f"{name} = {expression}")
        return name

    def _flush(self) -> None:
        """Write the fields of fixed size that have come together."""
        if not self._run:
            return
        for name, values in self._exact.items():
            if values:
                classes = " is ".join(f"{value}.__class__" for value in values)
                self._code.block(f"if not ({name} is {classes}):")
                self._code.add(f"exactly({name}, {', '.join(values)})")
                self._code.end()
                values.clear()
        structs = self._run.structs("<")
        pack = self._code.constant([each.pack for each in structs])
        sizes = self._code.constant([each.size for each in structs])
        self._code.add(f"p({pack}[n & 7]({', '.join(self._run.expressions())}))")
        self._code.add(f"n += {sizes}[n & 7]")
        self._run = Run()
