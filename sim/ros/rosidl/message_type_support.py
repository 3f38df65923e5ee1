"""The type support of a message: what a compiled package has in C, made with ctypes.

rclpy creates a C message, has it filled from a Python message, and gives it to rcl; what it holds is only known to the
functions of this type support. Here it is a Python object, `MessageBox`.

Fast DDS holds locks while it has a message written or read. Another thread must not be given the interpreter then, and
wait for such a lock without ever giving the interpreter back. A message is written without Python code: what is called
is a `functools.partial` of the C++ function that appends bytes. It is read by Python code, and only threads that
publish or take messages of the same type wait for the lock that is held meanwhile. So one thread at a time has boxes
of a type, and the others wait before they call Fast DDS, where waiting gives the interpreter to others.

Source: rclpy 7.1 (`convert_from_py`, `convert_to_py`, `create_from_py`)
Source: rmw_fastrtps_cpp 8.4 (`type_support_common.cpp`)
"""

from __future__ import annotations

import ctypes as c
import functools
import logging
import operator
import threading
from collections.abc import Callable
from typing import Any

from gz_course.sim.ros.rosidl import fast_cdr
from gz_course.sim.ros.rosidl.c_structs import (
    MessageCallbacks,
    MessageTypeSupport,
    address,
    capsule,
    keep,
)
from gz_course.sim.ros.rosidl.cdr_reader import Decode, MalformedError, decoder
from gz_course.sim.ros.rosidl.cdr_writer import Encode, encoder
from gz_course.sim.ros.rosidl.described_type import DescribedType
from gz_course.sim.ros.rosidl.introspection import IDENTIFIER as INTROSPECTION
from gz_course.sim.ros.rosidl.introspection import message_members

IDENTIFIER = b"rosidl_typesupport_fastrtps_c"
_BYTE_ORDERS = {b"\0\0": ">", b"\0\1": "<"}  # the encapsulation headers of XCDR version 1

_log = logging.getLogger("rosidl")
_boxes: dict[int, Any] = {}


def _object_with_true_address() -> object:
    """Return an object whose address, read as a C `bool`, is true."""
    made = [object()]
    while not id(made[-1]) & 0xFF:
        made.append(object())
    return made[-1]


_TRUE = keep(_object_with_true_address())


class MessageBox(functools.partial):
    """A C message: called with the address of a Cdr it writes its bytes.

    The functions that rclpy calls with it are those behind `|` and `~` of the C API of Python, and not callbacks of
    ctypes, because an exception can leave only the former: `message | box` fills the box, `~box` is the message.
    """

    __slots__ = ("message", "size", "support")
    message: Any
    size: int
    support: MessageSupport

    def __ror__(self, message: Any) -> object:
        data = self.support.encoded(message)
        self.__setstate__(  # type: ignore[attr-defined]
            (fast_cdr.write, (), {"data": data, "size": len(data)}, None)
        )
        self.message = message
        self.size = len(data)
        return _TRUE

    def __invert__(self) -> Any:
        return self.message


class MessageSupport:
    """The type support of one message class; `pointer` is that of the rosidl_message_type_support_t."""

    def __init__(self, message_class: Any, described: DescribedType) -> None:
        self.message_class = message_class
        self.described = described
        self._encode: Encode | None = None
        self._decode: dict[str, Decode] = {}
        self._has_warned = False
        self.turn: Any = threading.RLock()
        package, kind, name = described.name.split("/")
        self.introspection = message_members(message_class, f"{package}__{kind}", name)
        callbacks = MessageCallbacks(
            keep(f"{package}::{kind}".encode()),
            keep(name.encode()),
            _SERIALIZE,
            address(_Deserialize(self._deserialize)),
            _SERIALIZED_SIZE,
            _MAX_SIZE,
            None,
        )
        handle = address(_Handle(self._handle))
        self._introspection_support = MessageTypeSupport(
            INTROSPECTION, address(self.introspection), handle, *described.functions
        )
        self._support = MessageTypeSupport(IDENTIFIER, address(callbacks), handle, *described.functions)
        self.introspection_pointer = address(self._introspection_support)
        self.pointer = address(self._support)
        self._create = address(_Create(self._create_alone))

    def capsules(self) -> dict[str, Any]:
        """Return the attributes of the metaclass that rclpy reads."""
        return {
            "_TYPE_SUPPORT": capsule(self.pointer),
            "_CREATE_ROS_MESSAGE": capsule(self._create),
            "_DESTROY_ROS_MESSAGE": capsule(_DESTROY),
            "_CONVERT_FROM_PY": capsule(_FROM_PY),
            "_CONVERT_TO_PY": capsule(_TO_PY),
        }

    def create(self, message: Any = None) -> int:
        """Return the address of a new box, filled or not, which lives until it is destroyed."""
        box = MessageBox(_nothing)
        box.support = self
        box.size = 0
        box.message = None
        _boxes[id(box)] = box
        if message is not None:
            box.__ror__(message)
        return id(box)

    def _create_alone(self) -> int:
        """Return a new box for this thread, when no other thread has boxes of this type.

        The functions that write and read it are made before the first box: not while Fast DDS holds locks, and not for
        messages that are never sent, as most of those of an action are.
        """
        while True:  # an exception, which Ctrl-C can cause at any place, would leave C code with an address of nothing
            try:
                if not self.turn._is_owned():
                    self.turn.acquire()
                if self._encode is None:
                    self._decode = {order: decoder(self.message_class, order) for order in _BYTE_ORDERS.values()}
                    self._encode = encoder(self.message_class)
                return self.create()
            except KeyboardInterrupt:
                continue

    def encoded(self, message: Any) -> bytes:
        """Return the bytes of a message. Raises TypeError with a sentence that names the field."""
        try:
            return (self._encode or encoder(self.message_class))(message)
        except Exception as error:
            seen = _explanation(message) or str(error)
            raise TypeError(f"this {self.described.name} cannot be sent: {seen}") from None

    def _handle(self, _: int, identifier: bytes) -> int | None:
        if identifier == IDENTIFIER:
            return self.pointer
        return self.introspection_pointer if identifier == INTROSPECTION else None

    def _deserialize(self, cdr: int, box: MessageBox) -> bool:
        """Read the message of a buffer into a box; return whether it could be read."""
        while True:
            try:
                box.message = self._read(cdr)
                return True
            except KeyboardInterrupt:
                continue
            except Exception as error:
                self._warn(error)
                return False

    def _read(self, cdr: int) -> Any:
        header, data = fast_cdr.received(cdr)
        order = _BYTE_ORDERS.get(header[:2])
        if order is None:
            raise MalformedError(f"its encoding {header.hex() or 'is missing and'} is not known")
        return self._decode[order](data)

    def _warn(self, error: Exception) -> None:
        if not self._has_warned:
            self._has_warned = True
            _log.warning(
                "A message that is no %s was dropped: %s. More of them are dropped without a word.",
                self.described.name,
                error,
            )


def message_at(pointer: int) -> Any:
    """Return the message in the box with this address."""
    return _boxes[pointer].message


def destroy_event(pointer: int) -> bool:
    """Let go of a box that belongs to no thread; return whether there was one."""
    return _boxes.pop(pointer, None) is not None


def _destroy(pointer: int) -> None:
    """Let go of a box, and let other threads make boxes of its type."""
    while True:
        try:
            box = _boxes.get(pointer)
            if box is not None and box.support.turn._is_owned():
                box.support.turn.release()
            _boxes.pop(pointer, None)
            return
        except KeyboardInterrupt:
            continue


def _nothing(cdr: int) -> int:
    return 0


def _explanation(message: Any, place: str = "") -> str:
    """Return which field of a message has a wrong value; empty if the setters find none."""
    fields = message._fields_and_field_types
    try:
        type(message)(check_fields=True, **{field: getattr(message, field) for field in fields})
    except AssertionError as error:
        return f"{f'in {place}: ' if place else ''}{error}"
    for field in fields:
        values = getattr(message, field)
        for value in values if isinstance(values, list | tuple) else [values]:
            inside = f"{place}.{field}" if place else field
            if hasattr(value, "SLOT_TYPES") and (found := _explanation(value, inside)):
                return found
    return ""


def _exported(name: str) -> int:
    return address(getattr(c.pythonapi, name))


# Called by rclpy, with the interpreter's lock.
_Create = c.PYFUNCTYPE(c.c_void_p)
_FROM_PY = _exported("PyNumber_Or")
_TO_PY = _exported("PyNumber_Invert")
_DESTROY = address(c.PYFUNCTYPE(None, c.c_void_p)(_destroy))
# Called by Fast DDS. The callables of the first two are written in C.
_SERIALIZE = address(c.PYFUNCTYPE(c.c_bool, c.py_object, c.c_void_p)(operator.call))
_SERIALIZED_SIZE = address(c.PYFUNCTYPE(c.c_uint32, c.py_object)(operator.attrgetter("size")))
_Deserialize: Callable[..., Any] = c.PYFUNCTYPE(c.c_bool, c.c_void_p, c.py_object)
_Handle: Callable[..., Any] = c.PYFUNCTYPE(c.c_void_p, c.c_void_p, c.c_char_p)


def _unbounded(bounds: Any) -> int:
    bounds[0] = 0
    return 0


_MAX_SIZE = address(c.PYFUNCTYPE(c.c_size_t, c.POINTER(c.c_char))(_unbounded))
