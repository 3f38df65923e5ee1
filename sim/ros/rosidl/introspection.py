"""The introspection of a message: names and types of its fields, from which Fast DDS makes its own type object.

Only what describes a field is filled in. The C message is a `MessageBox`, so there are no functions that reach into it.

Source: rosidl_typesupport_introspection_c 4.6 (`field_types.h`, `message_introspection.h`)
"""

from __future__ import annotations

import ctypes as c
from typing import Any

from rosidl_parser import definition as idl

from gz_course.sim.ros.rosidl import c_structs as cs
from gz_course.sim.ros.rosidl.nested_classes import nested_class

IDENTIFIER = b"rosidl_typesupport_introspection_c"
_TYPES = {
    **{"float": 1, "double": 2, "boolean": 6, "octet": 7, "uint8": 8, "int8": 9, "uint16": 10, "int16": 11},
    **{"uint32": 12, "int32": 13, "uint64": 14, "int64": 15},
}
_STRING, _WSTRING, _MESSAGE = 16, 17, 18

_handle_of = c.PyDLL("librosidl_runtime_c.so").get_message_typesupport_handle
_handle_of.restype, _handle_of.argtypes = c.c_void_p, [c.c_void_p, c.c_char_p]


def message_members(message_class: Any, namespace: str, name: str) -> cs.MessageMembers:
    """Return the introspection of a message class; `namespace` is `package__msg`."""
    fields = zip(message_class._fields_and_field_types, message_class.SLOT_TYPES, strict=True)
    members = [_member(field, kind) for field, kind in fields] or [
        _member(idl.EMPTY_STRUCTURE_REQUIRED_MEMBER_NAME, idl.BasicType("uint8"))
    ]
    array = (cs.MessageMember * len(members))(*members)
    return cs.MessageMembers(
        cs.keep(namespace.encode()), cs.keep(name.encode()), len(members), 1, False, cs.address(array), None, None
    )


def _member(name: str, kind: idl.AbstractType) -> cs.MessageMember:
    inner = kind.value_type if isinstance(kind, idl.AbstractNestedType) else kind
    bounded = isinstance(kind, idl.BoundedSequence)
    member = cs.MessageMember(name=cs.keep(name.encode()))
    member.is_array = inner is not kind
    member.is_upper_bound = bounded
    member.array_size = kind.maximum_size if bounded else getattr(kind, "size", 0)
    if isinstance(inner, idl.NamespacedType):
        member.type_id = _MESSAGE
        member.members = _nested_introspection(nested_class(inner))
    elif isinstance(inner, idl.BasicType):
        member.type_id = _TYPES[inner.typename]
    else:
        member.type_id = _WSTRING if isinstance(inner, idl.AbstractWString) else _STRING
        member.string_upper_bound = getattr(inner, "maximum_size", 0)
    return member


def _nested_introspection(message_class: Any) -> int:
    """Return the introspection type support of a class, compiled or not."""
    metaclass = type(message_class)
    if metaclass._TYPE_SUPPORT is None:
        metaclass.__import_type_support__()
    return _handle_of(cs.pointer_in(metaclass._TYPE_SUPPORT), IDENTIFIER)
