"""The C structures that rcl and Fast DDS expect of a type support.

Source: headers of rosidl_runtime_c 4.6, rosidl_typesupport_introspection_c 4.6 and rosidl_typesupport_fastrtps_cpp 3.6
"""

from __future__ import annotations

import ctypes as c
from typing import Any

POINTER = c.c_void_p


class String(c.Structure):
    """A text: rosidl_runtime_c__String."""

    _fields_ = [("data", c.c_char_p), ("size", c.c_size_t), ("capacity", c.c_size_t)]


class Sequence(c.Structure):
    """A sequence of any type: the three words that each of them has."""

    _fields_ = [("data", POINTER), ("size", c.c_size_t), ("capacity", c.c_size_t)]


class FieldType(c.Structure):
    """The type of a field in a type description."""

    _fields_ = [
        ("type_id", c.c_uint8),
        ("capacity", c.c_uint64),
        ("string_capacity", c.c_uint64),
        ("nested_type_name", String),
    ]


class Field(c.Structure):
    """A field in a type description."""

    _fields_ = [("name", String), ("type", FieldType), ("default_value", String)]


class IndividualTypeDescription(c.Structure):
    """A type without those it refers to."""

    _fields_ = [("type_name", String), ("fields", Sequence)]


class TypeDescription(c.Structure):
    """A type with all it refers to."""

    _fields_ = [("type_description", IndividualTypeDescription), ("referenced_type_descriptions", Sequence)]


class TypeHash(c.Structure):
    """The hash of a type: version and SHA-256."""

    _fields_ = [("version", c.c_uint8), ("value", c.c_uint8 * 32)]


class MessageTypeSupport(c.Structure):
    """A rosidl_message_type_support_t."""

    _fields_ = [
        ("typesupport_identifier", c.c_char_p),
        ("data", POINTER),
        ("func", POINTER),
        ("get_type_hash_func", POINTER),
        ("get_type_description_func", POINTER),
        ("get_type_description_sources_func", POINTER),
    ]


class ServiceTypeSupport(c.Structure):
    """A rosidl_service_type_support_t."""

    _fields_ = [
        ("typesupport_identifier", c.c_char_p),
        ("data", POINTER),
        ("func", POINTER),
        ("request_typesupport", POINTER),
        ("response_typesupport", POINTER),
        ("event_typesupport", POINTER),
        ("event_message_create_handle_function", POINTER),
        ("event_message_destroy_handle_function", POINTER),
        ("get_type_hash_func", POINTER),
        ("get_type_description_func", POINTER),
        ("get_type_description_sources_func", POINTER),
    ]


class ActionTypeSupport(c.Structure):
    """A rosidl_action_type_support_t."""

    _fields_ = [
        ("goal_service_type_support", POINTER),
        ("result_service_type_support", POINTER),
        ("cancel_service_type_support", POINTER),
        ("feedback_message_type_support", POINTER),
        ("status_message_type_support", POINTER),
        ("get_type_hash_func", POINTER),
        ("get_type_description_func", POINTER),
        ("get_type_description_sources_func", POINTER),
    ]


class MessageCallbacks(c.Structure):
    """A message_type_support_callbacks_t: how Fast DDS has a message written and read."""

    _fields_ = [
        ("message_namespace", c.c_char_p),
        ("message_name", c.c_char_p),
        ("cdr_serialize", POINTER),
        ("cdr_deserialize", POINTER),
        ("get_serialized_size", POINTER),
        ("max_serialized_size", POINTER),
        ("key_callbacks", POINTER),
    ]


class ServiceCallbacks(c.Structure):
    """A service_type_support_callbacks_t."""

    _fields_ = [
        ("service_namespace", c.c_char_p),
        ("service_name", c.c_char_p),
        ("request_members", POINTER),
        ("response_members", POINTER),
    ]


class MessageMember(c.Structure):
    """A field in the introspection of a message."""

    _fields_ = [
        ("name", c.c_char_p),
        ("type_id", c.c_uint8),
        ("string_upper_bound", c.c_size_t),
        ("members", POINTER),
        ("is_key", c.c_bool),
        ("is_array", c.c_bool),
        ("array_size", c.c_size_t),
        ("is_upper_bound", c.c_bool),
        ("offset", c.c_uint32),
        ("default_value", POINTER),
        ("size_function", POINTER),
        ("get_const_function", POINTER),
        ("get_function", POINTER),
        ("fetch_function", POINTER),
        ("assign_function", POINTER),
        ("resize_function", POINTER),
    ]


class MessageMembers(c.Structure):
    """The introspection of a message."""

    _fields_ = [
        ("message_namespace", c.c_char_p),
        ("message_name", c.c_char_p),
        ("member_count", c.c_uint32),
        ("size_of", c.c_size_t),
        ("has_any_key_member", c.c_bool),
        ("members", POINTER),
        ("init_function", POINTER),
        ("fini_function", POINTER),
    ]


class ServiceMembers(c.Structure):
    """The introspection of a service."""

    _fields_ = [
        ("service_namespace", c.c_char_p),
        ("service_name", c.c_char_p),
        ("request_members", POINTER),
        ("response_members", POINTER),
        ("event_members", POINTER),
    ]


class ServiceEventInfo(c.Structure):
    """A rosidl_service_introspection_info_t."""

    _fields_ = [
        ("event_type", c.c_uint8),
        ("stamp_sec", c.c_int32),
        ("stamp_nanosec", c.c_uint32),
        ("client_gid", c.c_uint8 * 16),
        ("sequence_number", c.c_int64),
    ]


_alive: list[Any] = []


def keep(thing: Any) -> Any:
    """Return a thing that C code has a pointer to; it lives as long as the process."""
    _alive.append(thing)
    return thing


_FUNCTION: Any = c.CFUNCTYPE(None).__base__


def address(thing: Any) -> int:
    """Return the address of a structure or function, and keep it alive."""
    if isinstance(thing, _FUNCTION):
        return c.cast(keep(thing), c.c_void_p).value or 0
    return c.addressof(keep(thing))


def text(value: str) -> String:
    """Return a text for C; its bytes are kept alive."""
    data = keep(value.encode())
    return String(data, len(data), len(data) + 1)


def sequence(kind: type[Any], items: list[Any]) -> Sequence:
    """Return a sequence of these structures, kept alive."""
    return Sequence(address((kind * len(items))(*items)), len(items), len(items))


_new_capsule = c.pythonapi.PyCapsule_New
_new_capsule.restype, _new_capsule.argtypes = c.py_object, [c.c_void_p, c.c_char_p, c.c_void_p]
_capsule_pointer = c.pythonapi.PyCapsule_GetPointer
_capsule_pointer.restype, _capsule_pointer.argtypes = c.c_void_p, [c.py_object, c.c_char_p]


def capsule(pointer: int) -> Any:
    """Return a Python object that holds a pointer, as rclpy takes it from a message class."""
    return _new_capsule(pointer, None, None)


def pointer_in(held: Any) -> int:
    """Return the pointer in a capsule."""
    return _capsule_pointer(held, None)
