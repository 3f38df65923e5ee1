"""Writes and reads messages as bytes: the CDR encoding of ROS 2 messages (XCDR version 1).

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

from gz_course.sim.ros.rosidl.cdr_layout import FORMATS, Run, smallest_size
from gz_course.sim.ros.rosidl.field_checks import TYPE_CODES, dtype_name, is_number_array
from gz_course.sim.ros.rosidl.message_class import CHECK_FIELDS
from gz_course.sim.ros.rosidl.nested_classes import nested_class

Encode = Callable[[Any], bytes]
Decode = Callable[[bytes], Any]


_EXACT = {"float": "float", "double": "float", "boolean": "bool"}
_NATIVE_UTF_16 = f"utf-16-{sys.byteorder[0]}e"


class MalformedError(ValueError):
    """Bytes that are not a message of the expected type."""


@functools.cache
def encoder(message_class: type) -> Encode:
    """Return the function that writes a message. It raises what a wrong value in a field causes."""
    code = _Code(
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


@functools.cache
def decoder(message_class: type, byte_order: str = "<") -> Decode:
    """Return the function that makes a message from bytes. It raises MalformedError, whatever the bytes are."""
    code = _Code({"array": array.array, "text": _text, "wide": _wide, "fail": _fail, "ndarray": _ndarray})
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


def _zero_ended(text: str) -> bytes:
    """Return the bytes of a text, which ends at its first zero as in C."""
    return (text.encode() + b"\0").partition(b"\0")[0] + b"\0"


def _text(data: bytes) -> str:
    return data.partition(b"\0")[0].decode("utf-8", "replace")


def _units(text: str) -> bytes:
    """Return the units of UTF-16 of a wide text, four bytes each."""
    return array.array("I", array.array("H", text.encode(_NATIVE_UTF_16))).tobytes()


def _wide(data: bytes, swapped: bool) -> str:
    units = array.array("I", data)
    if swapped:
        units.byteswap()
    return array.array("H", [unit & 0xFFFF for unit in units]).tobytes().decode(_NATIVE_UTF_16, "replace")


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


def _ndarray(data: bytes, dtype: Any, count: int, offset: int, byte_order: str) -> Any:
    from numpy import frombuffer

    values = frombuffer(data, dtype.newbyteorder(byte_order), count, offset)
    return values.astype(dtype)


class _Code:
    """The text of a function that grows, and the objects that it uses."""

    def __init__(self, names: dict[str, Any]) -> None:
        self.names = dict(names)
        self._lines: list[str] = []
        self._depth = 1
        self._made = 0

    def add(self, line: str) -> None:
        self._lines.append("    " * self._depth + line)

    def block(self, line: str) -> None:
        self.add(line)
        self._depth += 1

    def end(self) -> None:
        self._depth -= 1

    def local(self) -> str:
        """Return a name for a variable that is used nowhere else."""
        self._made += 1
        return f"v{self._made}"

    def constant(self, value: Any) -> str:
        self._made += 1
        name = f"C{self._made}"
        self.names[name] = value
        return name

    def function(self, argument: str, before: list[str], after: str) -> Any:
        lines = [f"def made({argument}):", *(f"    {line}" for line in before), *self._lines, f"    {after}"]
        exec(compile("\n".join(lines), "<cdr>", "exec"), self.names)
        return self.names["made"]


class _Writer:
    """Generates the code that writes a message; `n` is the offset, `p` appends bytes to the result."""

    def __init__(self, code: _Code) -> None:
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


class _Reader:
    """Generates the code that reads a message from `b`; `o` is the offset, and nothing is read beyond `size`.

    A count is compared with the bytes that are left before anything is made of that size.
    """

    def __init__(self, code: _Code, byte_order: str) -> None:
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
