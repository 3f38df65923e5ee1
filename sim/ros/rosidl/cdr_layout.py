"""How fields of fixed size lie behind each other in CDR, for every offset at which they may begin."""

from __future__ import annotations

import struct
from typing import Any

from rosidl_parser import definition as idl

from gz_course.sim.ros.rosidl.nested_classes import nested_class

FORMATS = {
    **{"boolean": "?", "octet": "c", "float": "f", "double": "d", "int8": "b", "uint8": "B", "int16": "h"},
    **{"uint16": "H", "int32": "i", "uint32": "I", "int64": "q", "uint64": "Q"},
}
"""The letter of `struct` for each basic type."""


class Run:
    """Fields of fixed size that follow each other, each with the expression for its value."""

    def __init__(self) -> None:
        self._fields: list[tuple[str, str]] = []

    def __bool__(self) -> bool:
        return bool(self._fields)

    def add(self, letter: str, expression: str) -> None:
        """Add a field; the letter `x` is a byte without a value."""
        self._fields.append((letter, expression))

    def expressions(self) -> list[str]:
        return [expression for letter, expression in self._fields if letter != "x"]

    def structs(self, byte_order: str) -> list[struct.Struct]:
        """Return the layout for each offset, modulo 8, at which the first field may begin; padding included."""
        return [struct.Struct(byte_order + self._padded(offset)) for offset in range(8)]

    def _padded(self, offset: int) -> str:
        letters = ""
        for letter, _ in self._fields:
            width = struct.calcsize(letter)
            padding = -offset % width
            letters += "x" * padding + letter
            offset += padding + width
        return letters


def smallest_size(kind: Any) -> int:
    """Return a number of bytes, at least 1, that every value of a type has."""
    if isinstance(kind, idl.BasicType):
        return struct.calcsize(FORMATS[kind.typename])
    if isinstance(kind, idl.Array):
        return kind.size * smallest_size(kind.value_type)
    if isinstance(kind, idl.NamespacedType):
        return max(1, sum(map(smallest_size, nested_class(kind).SLOT_TYPES)))
    return 4  # the count of a text or sequence
