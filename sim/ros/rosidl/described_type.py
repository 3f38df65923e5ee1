"""Hash and description of a type for rcl, which publishes them in the graph and serves them to other nodes."""

from __future__ import annotations

import ctypes as c
from typing import Any

from gz_course.sim.ros.rosidl import c_structs as cs
from gz_course.sim.ros.rosidl.type_description import Description, type_hash

_Get = c.PYFUNCTYPE(c.c_void_p, c.c_void_p)
_no_sources = cs.Sequence(None, 0, 0)
_GET_SOURCES = cs.address(_Get(lambda _: c.addressof(_no_sources)))


class DescribedType:
    """A type with its full description; `functions` are the three pointers at the end of every type support."""

    def __init__(self, description: Description) -> None:
        self.name: str = description["type_description"]["type_name"]
        self.hash = type_hash(description)
        self._description = description
        self._hash_struct = cs.keep(cs.TypeHash(1, (c.c_uint8 * 32).from_buffer_copy(bytes.fromhex(self.hash[7:]))))
        self._struct: Any = None
        self.functions = (
            cs.address(_Get(lambda _: c.addressof(self._hash_struct))),
            cs.address(_Get(lambda _: c.addressof(self._described()))),
            _GET_SOURCES,
        )

    def _described(self) -> Any:
        if self._struct is None:
            referenced = [_individual(each) for each in self._description["referenced_type_descriptions"]]
            self._struct = cs.keep(
                cs.TypeDescription(
                    _individual(self._description["type_description"]),
                    cs.sequence(cs.IndividualTypeDescription, referenced),
                )
            )
        return self._struct


def _individual(description: Description) -> Any:
    fields = [
        cs.Field(
            cs.text(field["name"]),
            cs.FieldType(
                field["type"]["type_id"],
                field["type"]["capacity"],
                field["type"]["string_capacity"],
                cs.text(field["type"]["nested_type_name"]),
            ),
            cs.text(field["default_value"]),
        )
        for field in description["fields"]
    ]
    return cs.IndividualTypeDescription(cs.text(description["type_name"]), cs.sequence(cs.Field, fields))
