"""What a field of a message class takes: the checks of its setter, and the value it has in a new message.

The checks are those of a generated class, with its sentences; they are made when the message was created with
`check_fields=True` or the environment has ROS_PYTHON_CHECK_FIELDS=1.

Source: rosidl_generator_py 0.22 (`_msg.py.em`, `generate_py_impl.py`)
"""

from __future__ import annotations

import array
import math
from ast import literal_eval
from collections import UserList, UserString
from collections.abc import Callable, Sequence, Set
from typing import Any

from rosidl_parser import definition as idl

TYPE_CODES = {
    **{"float": "f", "double": "d", "int8": "b", "uint8": "B", "int16": "h", "uint16": "H"},
    **{"int32": "i", "uint32": "I", "int64": "q", "uint64": "Q"},
}
"""Numbers whose sequences are an `array.array`, and whose arrays are a `numpy.ndarray`; with their type code."""

_NUMPY_NAMES = {"float": "float32", "double": "float64"}
_PYTHON_TYPES: dict[str, type] = {"boolean": bool, "octet": bytes, "float": float, "double": float}
_LARGEST = {"float": 3.402823466e38, "double": 1.7976931348623157e308}

Check = Callable[[str, Any], None]
"""Takes name and value of a field. Raises AssertionError with the sentence of a generated class."""


def dtype_name(typename: str) -> str:
    """Return the name that numpy has for a number."""
    return _NUMPY_NAMES.get(typename, typename)


def is_number_array(kind: idl.AbstractType) -> bool:
    """Whether a field holds an `array.array` or a `numpy.ndarray`."""
    if not isinstance(kind, idl.AbstractNestedType) or not isinstance(kind.value_type, idl.BasicType):
        return False
    return kind.value_type.typename in TYPE_CODES


def stored(kind: idl.AbstractType) -> Callable[[Any], Any] | None:
    """Return what makes the stored value from an assigned one; None if it is stored as it is."""
    if not is_number_array(kind):
        return None
    code = TYPE_CODES[kind.value_type.typename]
    if isinstance(kind, idl.Array):
        import numpy

        dtype = numpy.dtype(dtype_name(kind.value_type.typename))
        return lambda value: numpy.array(value, dtype=dtype)
    return lambda value: array.array(code, value)


def python_value(kind: idl.AbstractType, value: Any) -> Callable[[], Any]:
    """Return what makes the Python value of a default, anew each time because it may be a list."""
    if not isinstance(kind, idl.AbstractNestedType):
        plain = plain_value(kind, value)
        return lambda: plain
    values = [plain_value(kind.value_type, each) for each in literal_eval(value)]
    make = stored(kind)
    return (lambda: make(values)) if make else (lambda: list(values))


def plain_value(kind: idl.AbstractType, value: Any) -> Any:
    """Return the Python value of a constant, or of one element of a default."""
    if isinstance(kind, idl.BasicType) and kind.typename == "octet":
        return bytes([value])
    return value


def checks(kind: idl.AbstractType, nested_class: Callable[[idl.NamespacedType], type]) -> Check:
    """Return the check of a field of this type; `nested_class` finds the class of a message."""
    if isinstance(kind, idl.AbstractNestedType):
        return _sequence_check(kind, nested_class)
    if isinstance(kind, idl.NamespacedType):
        return _message_check(kind, nested_class)
    if isinstance(kind, idl.BasicType):
        return _octet_check if kind.typename == "octet" else _basic_check(kind)
    return _string_check(kind)


def array_check(kind: idl.AbstractType) -> Callable[[str, Any], bool] | None:
    """Return the check of an array that is stored as it is; None if the field holds no array of numbers.

    The check returns whether the value is such an array.
    """
    if not is_number_array(kind):
        return None
    code = TYPE_CODES[kind.value_type.typename]
    if isinstance(kind, idl.Array):
        import numpy

        name = dtype_name(kind.value_type.typename)
        dtype = numpy.dtype(name)

        def is_ndarray(field: str, value: Any) -> bool:
            if not isinstance(value, numpy.ndarray):
                return False
            _expect(value.dtype == dtype, f"The '{field}' numpy.ndarray() must have the dtype of 'numpy.{name}'")
            _expect(value.size == kind.size, f"The '{field}' numpy.ndarray() must have a size of {kind.size}")
            return True

        return is_ndarray
    bound = getattr(kind, "maximum_size", None)

    def is_array(field: str, value: Any) -> bool:
        if not isinstance(value, array.array):
            return False
        _expect(value.typecode == code, f"The '{field}' array.array() must have the type code of '{code}'")
        if bound is not None:
            _expect(len(value) <= bound, f"The '{field}' array.array() must have a size <= {bound}")
        return True

    return is_array


def _expect(holds: bool, sentence: str) -> None:
    if not holds:
        raise AssertionError(sentence)


def _python_type(kind: idl.AbstractType) -> type:
    return _PYTHON_TYPES.get(kind.typename, int) if isinstance(kind, idl.BasicType) else str


def _integer_range(typename: str) -> tuple[int, int] | None:
    if "int" not in typename:
        return None
    bits = int(typename.lstrip("uint"))
    return (0, 2**bits - 1) if typename.startswith("u") else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)


def _in_float_range(value: float, bound: float) -> bool:
    return not (value < -bound or value > bound) or math.isinf(value)


def _basic_check(kind: idl.BasicType) -> Check:
    python_type, whole, bound = _python_type(kind), _integer_range(kind.typename), _LARGEST.get(kind.typename)

    def check(field: str, value: Any) -> None:
        _expect(isinstance(value, python_type), f"The '{field}' field must be of type '{python_type.__name__}'")
        if whole:
            noun = "an integer" if whole[0] else "an unsigned integer"
            fits = whole[0] <= value <= whole[1]
            _expect(fits, f"The '{field}' field must be {noun} in [{whole[0]}, {whole[1]}]")
        if bound:
            fits = _in_float_range(value, bound)
            _expect(fits, f"The '{field}' field must be a {kind.typename} in [{-bound}, {bound}]")

    return check


def _octet_check(field: str, value: Any) -> None:
    fits = isinstance(value, bytes | bytearray) and len(value) == 1
    _expect(fits, f"The '{field}' field must be of type 'bytes' or 'ByteString' with length 1")


def _string_check(kind: idl.AbstractGenericString) -> Check:
    bound = getattr(kind, "maximum_size", None)

    def check(field: str, value: Any) -> None:
        if bound is None:
            _expect(isinstance(value, str), f"The '{field}' field must be of type 'str'")
        else:
            fits = isinstance(value, str | UserString) and len(value) <= bound
            _expect(fits, f"The '{field}' field must be string value not longer than {bound}")

    return check


def _message_check(kind: idl.NamespacedType, nested_class: Callable[[idl.NamespacedType], type]) -> Check:
    def check(field: str, value: Any) -> None:
        fits = isinstance(value, nested_class(kind))
        _expect(fits, f"The '{field}' field must be a sub message of type '{kind.name}'")

    return check


def _sequence_check(kind: idl.AbstractNestedType, nested_class: Callable[[idl.NamespacedType], type]) -> Check:
    inner, size, most = kind.value_type, getattr(kind, "size", None), getattr(kind, "maximum_size", None)
    longest = getattr(inner, "maximum_size", None)
    whole = _integer_range(inner.typename) if isinstance(inner, idl.BasicType) else None
    bound = _LARGEST.get(inner.typename) if isinstance(inner, idl.BasicType) else None
    name = inner.name if isinstance(inner, idl.NamespacedType) else _python_type(inner).__name__
    words = ["a set or sequence"]
    words += [f"with length {size}"] if size is not None else []
    words += [f"with length <= {most}"] if most is not None else []
    words += [f"and each string value not longer than {longest}"] if longest is not None else []
    words.append(f"and each value of type '{name}'")
    if whole:
        words.append(f"and each {'integer' if whole[0] else 'unsigned integer'} in [{whole[0]}, {whole[1]}]")
    if bound:
        words.append(f"and each {inner.typename} in [{-bound:f}, {bound:f}]")
    sentence = " ".join(words)

    def check(field: str, value: Any) -> None:
        element = nested_class(inner) if isinstance(inner, idl.NamespacedType) else _python_type(inner)
        fits = (
            isinstance(value, Sequence | Set | UserList)
            and not isinstance(value, str | UserString)
            and (longest is None or all(len(each) <= longest for each in value))
            and (size is None or len(value) == size)
            and (most is None or len(value) <= most)
            and all(isinstance(each, element) for each in value)
            and (whole is None or all(whole[0] <= each <= whole[1] for each in value))
            and (bound is None or all(_in_float_range(each, bound) for each in value))
        )
        _expect(fits, f"The '{field}' field must be {sentence}")

    return check
