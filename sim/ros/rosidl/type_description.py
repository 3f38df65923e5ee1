"""Describes the types of interfaces as ROS 2 does, and computes their hashes.

A description is a dictionary with the form of `type_description_interfaces/msg/TypeDescription`; a package that is
installed brings those of its types in `share/PACKAGE/msg/Name.json`.

Source: REP-2016, https://github.com/ros-infrastructure/rep/pull/381 (RIHS01)
Source: rosidl_generator_type_description 4.6 (what is hashed; `FieldType.msg` for the numbers)
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Iterator
from typing import Any

from rosidl_parser import definition as idl

from gz_course.sim.ros.rosidl.interface_text import Interface

Description = dict[str, Any]

_NUMBERS = {
    **{"int8": 2, "uint8": 3, "int16": 4, "uint16": 5, "int32": 6, "uint32": 7, "int64": 8, "uint64": 9},
    **{"float": 10, "double": 11, "char": 13, "wchar": 14, "boolean": 15, "octet": 16},
}
_STRING_NUMBERS = {
    idl.UnboundedString: 17,
    idl.UnboundedWString: 18,
    idl.BoundedString: 21,
    idl.BoundedWString: 22,
}
_ARRAY_OFFSETS = {idl.Array: 48, idl.BoundedSequence: 96, idl.UnboundedSequence: 144}
_NESTED = 1


def type_name(kind: idl.NamespacedType) -> str:
    """Return `package/msg/Name`."""
    return "/".join(kind.namespaced_name())


def individual_descriptions(interface: Interface) -> Iterator[Description]:
    """Yield the description of an interface, without those of the types it refers to, and of all its parts."""
    if isinstance(interface, idl.Message):
        yield _individual(interface.structure.namespaced_type, interface.structure.members)
    elif isinstance(interface, idl.Service):
        parts = {
            "request_message": interface.request_message,
            "response_message": interface.response_message,
            "event_message": interface.event_message,
        }
        members = [idl.Member(part.structure.namespaced_type, name) for name, part in parts.items()]
        yield _individual(interface.namespaced_type, members)
        for part in parts.values():
            yield from individual_descriptions(part)
    else:
        messages = ("goal", "result", "feedback", "feedback_message")
        services = ("send_goal_service", "get_result_service")
        types = {name: getattr(interface, name).structure.namespaced_type for name in messages}
        types |= {name: getattr(interface, name).namespaced_type for name in services}
        order = (*messages[:3], *services, messages[3])
        yield _individual(interface.namespaced_type, [idl.Member(types[name], name) for name in order])
        for name in order:
            yield from individual_descriptions(getattr(interface, name))


def full_description(name: str, known: dict[str, Description]) -> Description:
    """Return the description of a type with all it refers to; `known` are individual descriptions by name."""
    found: set[str] = set()
    todo = [name]
    while todo:
        for field in known[todo.pop()]["fields"]:
            nested = field["type"]["nested_type_name"]
            if nested and nested not in found:
                found.add(nested)
                todo.append(nested)
    return {"type_description": known[name], "referenced_type_descriptions": [known[each] for each in sorted(found)]}


def type_hash(description: Description) -> str:
    """Return `RIHS01_` and 64 digits for a full description; default values are not part of it."""
    hashed = {
        "type_description": _without_defaults(description["type_description"]),
        "referenced_type_descriptions": [_without_defaults(d) for d in description["referenced_type_descriptions"]],
    }
    return f"RIHS01_{hashlib.sha256(json.dumps(hashed).encode()).hexdigest()}"


def _without_defaults(individual: Description) -> Description:
    fields = [{"name": field["name"], "type": field["type"]} for field in individual["fields"]]
    return {"type_name": individual["type_name"], "fields": fields}


def _individual(name: idl.NamespacedType, members: Iterable[idl.Member]) -> Description:
    return {"type_name": type_name(name), "fields": [_field(member) for member in members]}


def _field(member: idl.Member) -> Description:
    default = member.get_annotation_value("default")["value"] if member.has_annotation("default") else ""
    return {"name": member.name, "type": _field_type(member.type), "default_value": str(default)}


def _field_type(kind: idl.AbstractType) -> Description:
    inner, number = kind, 0
    capacity: Any = 0
    if isinstance(kind, idl.AbstractNestedType):
        inner, number = kind.value_type, _ARRAY_OFFSETS[type(kind)]
        capacity = getattr(kind, "size", None) or getattr(kind, "maximum_size", 0)
    nested = ""
    if isinstance(inner, idl.BasicType):
        number += _NUMBERS[inner.typename]
    elif isinstance(inner, idl.NamespacedType):
        number += _NESTED
        nested = type_name(inner)
    else:
        number += _STRING_NUMBERS[type(inner)]
    return {
        "type_id": number,
        "capacity": capacity,
        "string_capacity": getattr(inner, "maximum_size", 0),
        "nested_type_name": nested,
    }
