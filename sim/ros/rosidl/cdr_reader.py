"""Generates what reads a message from bytes in CDR; `cdr_writer.py` describes the encoding."""

from __future__ import annotations

import array
import functools
import struct
import sys
from collections.abc import Callable
from typing import Any

from rosidl_parser import definition as idl

from gz_course.sim.ros.rosidl.cdr_code import Code
from gz_course.sim.ros.rosidl.cdr_layout import FORMATS, Run, smallest_size
from gz_course.sim.ros.rosidl.cdr_writer import NATIVE_UTF_16
from gz_course.sim.ros.rosidl.field_checks import TYPE_CODES, dtype_name, is_number_array
from gz_course.sim.ros.rosidl.message_class import CHECK_FIELDS
from gz_course.sim.ros.rosidl.nested_classes import nested_class

Decode = Callable[[bytes], Any]


class MalformedError(ValueError):
    """Bytes that are not a message of the expected type."""


@functools.cache
def decoder(message_class: type, byte_order: str = "<") -> Decode:
    """Return the function that makes a message from bytes. It raises MalformedError, whatever the bytes are."""
    code = Code({"array": array.array, "text": _text, "wide": _wide, "fail": _fail, "ndarray": _ndarray})
    _Reader(code, byte_order).read(message_class, "m")
    read = code.function("b", ["o = 0", "size = len(b)"], "return m")

    def decode(data: bytes) -> Any:
        try:
            return read(data)
        except struct.error:
            raise MalformedError(f"it ends too early, after {len(data)} bytes") from None

    return decode


def _fail(sentence: str) -> None:
    raise MalformedError(sentence)


def _text(data: bytes) -> str:
    return data.partition(b"\0")[0].decode("utf-8", "replace")


def _wide(data: bytes, swapped: bool) -> str:
    units = array.array("I", data)
    if swapped:
        units.byteswap()
    return array.array("H", [unit & 0xFFFF for unit in units]).tobytes().decode(NATIVE_UTF_16, "replace")


def _ndarray(data: bytes, dtype: Any, count: int, offset: int, byte_order: str) -> Any:
    from numpy import frombuffer

    values = frombuffer(data, dtype.newbyteorder(byte_order), count, offset)
    return values.astype(dtype)


class _Reader:
    """Generates the code that reads a message from `b`; `o` is the offset, and nothing is read beyond `size`.

    A count is compared with the bytes that are left before anything is made of that size.
    """

    def __init__(self, code: Code, byte_order: str) -> None:
        self._code = code
        self._order = byte_order
        self._swapped = byte_order != ("<" if sys.byteorder == "little" else ">")
        self._run = Run()

    def read(self, message_class: Any, message: str) -> None:
        self._message(message_class, message)
        self._flush()

    def _message(self, message_class: Any, message: str) -> None:
        new = self._code.constant(functools.partial(object.__new__, message_class))
        self._code.add(f"{message} = {new}()")
        self._code.add(f"{message}._check_fields = {CHECK_FIELDS}")
        if not message_class.SLOT_TYPES:
            self._run.add("x", "")
        for slot, kind in zip(message_class.__slots__, message_class.SLOT_TYPES, strict=False):
            self._field(kind, f"{message}.{slot}")

    def _field(self, kind: Any, target: str) -> None:
        if isinstance(kind, idl.AbstractNestedType):
            self._elements(kind, target)
        elif isinstance(kind, idl.BasicType):
            self._run.add(FORMATS[kind.typename], target)
        elif isinstance(kind, idl.NamespacedType):
            message = self._code.local()
            self._message(nested_class(kind), message)
            self._code.add(f"{target} = {message}")
        else:
            wide = isinstance(kind, idl.AbstractWString)
            data = self._bytes(self._counted(), 4 if wide else 1)
            self._code.add(f"{target} = " + (f"wide({data}, {self._swapped})" if wide else f"text({data})"))

    def _elements(self, kind: Any, target: str) -> None:
        inner, size, most = kind.value_type, getattr(kind, "size", None), getattr(kind, "maximum_size", None)
        if size is None:
            count = self._counted()
            if most is not None:
                self._code.block(f"if {count} > {most}:")
                self._code.add(f"fail(f'a sequence has {{{count}}} elements, at most {most} are allowed')")
                self._code.end()
        else:
            self._flush()
            count = str(size)
        if isinstance(inner, idl.BasicType):
            self._plain_elements(kind, inner, count, target)
            return
        self._expect(count, smallest_size(inner))
        values, element = self._code.local(), self._code.local()
        self._code.add(f"{values} = []")
        self._code.block(f"for _ in range({count}):")
        self._field(inner, element)
        self._flush()
        self._code.add(f"{values}.append({element})")
        self._code.end()
        self._code.add(f"{target} = {values}")

    def _plain_elements(self, kind: Any, inner: idl.BasicType, count: str, target: str) -> None:
        width = struct.calcsize(FORMATS[inner.typename])
        if not is_number_array(kind):
            data = self._bytes(count, 1)
            each = "bytes((x,))" if inner.typename == "octet" else "x != 0"
            self._code.add(f"{target} = [{each} for x in {data}]")
            return
        code = TYPE_CODES[inner.typename]
        if width > 1:
            self._code.block(f"if {count}:")
            self._code.add(f"o += -o & {width - 1}")
            self._code.end()
        self._expect(count, width)
        if isinstance(kind, idl.Array):
            import numpy

            dtype = self._code.constant(numpy.dtype(dtype_name(kind.value_type.typename)))
            self._code.add(f"{target} = ndarray(b, {dtype}, {count}, o, {self._order!r})")
        else:
            values = self._code.local()
            self._code.add(f"{values} = array({code!r})")
            self._code.add(f"{values}.frombytes(memoryview(b)[o : o + {count} * {width}])")
            if self._swapped:
                self._code.add(f"{values}.byteswap()")
            self._code.add(f"{target} = {values}")
        self._code.add(f"o += {count} * {width}")

    def _counted(self) -> str:
        """Read the count that comes before a text or sequence; return its name."""
        count = self._code.local()
        self._run.add("I", count)
        self._flush()
        return count

    def _bytes(self, count: str, width: int) -> str:
        self._flush()
        self._expect(count, width)
        data = self._code.local()
        self._code.add(f"{data} = b[o : o + {count} * {width}]")
        self._code.add(f"o += {count} * {width}")
        return data

    def _expect(self, count: str, width: int) -> None:
        """Fail unless this many elements of at least `width` bytes can follow."""
        self._code.block(f"if {count} * {width} > size - o:")
        self._code.add(f"fail(f'{{{count}}} elements are announced, {{max(size - o, 0)}} bytes follow')")
        self._code.end()

    def _flush(self) -> None:
        if not self._run:
            return
        structs = self._run.structs(self._order)
        unpack = self._code.constant([each.unpack_from for each in structs])
        sizes = self._code.constant([each.size for each in structs])
        targets = "".join(f"{target}, " for target in self._run.expressions())
        self._code.add(f"{targets}{'= ' if targets else ''}{unpack}[o & 7](b, o)")
        self._code.add(f"o += {sizes}[o & 7]")
        self._run = Run()
