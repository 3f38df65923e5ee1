"""Makes the Python class of a message, equal to a generated one.

Source: rosidl_generator_py 0.22 (`_msg.py.em`)
"""

from __future__ import annotations

import operator
import os
from collections.abc import Callable
from copy import copy
from typing import Any

from rosidl_parser import definition as idl

from gz_course.sim.ros.rosidl import field_checks
from gz_course.sim.ros.rosidl.nested_classes import nested_class

CHECK_FIELDS = os.getenv("ROS_PYTHON_CHECK_FIELDS", default="") == "1"
"""Whether setters check by default, as asked for by the environment."""


def message_class(message: idl.Message, module: str, import_type_support: Callable[[type], None]) -> Any:
    """Return the class of a message.

    `module` becomes its `__module__`. Its metaclass calls `import_type_support` with the class when rclpy asks for the
    type support.
    """
    name = message.structure.namespaced_type.name
    members = [m for m in message.structure.members if m.name != idl.EMPTY_STRUCTURE_REQUIRED_MEMBER_NAME]
    constants = {c.name: field_checks.plain_value(c.type, c.value) for c in message.constants}
    defaults = {
        member.name: field_checks.python_value(member.type, member.get_annotation_value("default")["value"])
        for member in members
        if member.has_annotation("default")
    }
    metaclass = _metaclass(name, module, constants, defaults, import_type_support)
    title = f"Message class '{name}'."
    listed = "".join(f"\n      {constant}" for constant in constants)
    body = {
        "__module__": module,
        "__qualname__": name,
        "__doc__": f"\n    {title}\n\n    Constants:{listed}\n    " if listed else title,
        "__slots__": [*(f"_{member.name}" for member in members), "_check_fields"],
        "_fields_and_field_types": {member.name: field_type_text(member.type) for member in members},
        "SLOT_TYPES": tuple(member.type for member in members),
        "__init__": _initializer(members, defaults),
        "__repr__": _repr,
        "__eq__": _equality(members),
        "get_fields_and_field_types": classmethod(_get_fields_and_field_types),
    }
    made = metaclass(name, (), {**metaclass.__prepare__(name, ()), **body})
    for member in members:
        setattr(made, member.name, _field_property(made, member))
    return made


def field_type_text(kind: idl.AbstractType) -> str:
    """Return the type of a field as in `get_fields_and_field_types()`: `sequence<double, 3>`, `std_msgs/Header`."""
    inner = kind.value_type if isinstance(kind, idl.AbstractNestedType) else kind
    if isinstance(inner, idl.BasicType):
        text = inner.typename
    elif isinstance(inner, idl.NamespacedType):
        text = f"{inner.namespaces[0]}/{inner.name}"
    else:
        bound = getattr(inner, "maximum_size", None)
        text = ("w" if isinstance(inner, idl.AbstractWString) else "") + "string" + (f"<{bound}>" if bound else "")
    if isinstance(kind, idl.Array):
        return f"{text}[{kind.size}]"
    if isinstance(kind, idl.BoundedSequence):
        return f"sequence<{text}, {kind.maximum_size}>"
    return f"sequence<{text}>" if isinstance(kind, idl.UnboundedSequence) else text


def _metaclass(
    name: str,
    module: str,
    constants: dict[str, Any],
    defaults: dict[str, Callable[[], Any]],
    import_type_support: Callable[[type], None],
) -> Any:
    made: list[type] = []

    def create(metaclass: type, *arguments: Any) -> type:
        made.append(type.__new__(metaclass, *arguments))
        return made[-1]

    def prepare(metaclass: type, name: str, bases: tuple[type, ...], **_: Any) -> dict[str, Any]:
        return {**constants, **{f"{field.upper()}__DEFAULT": make() for field, make in defaults.items()}}

    body: dict[str, Any] = {
        "__module__": module,
        "__doc__": f"Metaclass of message '{name}'.",
        **dict.fromkeys(_CAPSULES),
        f"_Metaclass_{name}__constants": constants,
        "__new__": create,
        "__import_type_support__": classmethod(lambda metaclass: import_type_support(made[0])),
        "__prepare__": classmethod(prepare),
    }
    for constant, value in constants.items():
        body[constant] = property(_constantly(value), doc=f"Message constant '{constant}'.")
    for field, make in defaults.items():
        text = f"Return default value for message field '{field}'."
        body[f"{field.upper()}__DEFAULT"] = property(_made_by(make), doc=text)
    return type(f"Metaclass_{name}", (type,), body)


def _constantly(value: Any) -> Callable[[Any], Any]:
    return lambda _: value


def _made_by(make: Callable[[], Any]) -> Callable[[Any], Any]:
    return lambda _: make()


_CAPSULES = ("_CREATE_ROS_MESSAGE", "_CONVERT_FROM_PY", "_CONVERT_TO_PY", "_DESTROY_ROS_MESSAGE", "_TYPE_SUPPORT")


def _initializer(members: list[idl.Member], defaults: dict[str, Callable[[], Any]]) -> Callable[..., None]:
    new_values = [(member.name, defaults.get(member.name) or _new_value(member.type)) for member in members]
    names = {member.name for member in members} | {"check_fields"}

    def __init__(self: Any, **kwargs: Any) -> None:
        self._check_fields = kwargs.get("check_fields", CHECK_FIELDS)
        if self._check_fields and not names.issuperset(kwargs):
            unknown = ", ".join(sorted(kwargs.keys() - names))
            raise AssertionError(f"Invalid arguments passed to constructor: {unknown}")
        for name, make in new_values:
            setattr(self, name, kwargs[name] if name in kwargs else make())

    return __init__


def _new_value(kind: idl.AbstractType) -> Callable[[], Any]:
    """Return what makes the value of a field without a default."""
    if isinstance(kind, idl.AbstractSequence):
        return list
    if isinstance(kind, idl.Array):
        if field_checks.is_number_array(kind):
            import numpy

            dtype = numpy.dtype(field_checks.dtype_name(kind.value_type.typename))
            return lambda: numpy.zeros(kind.size, dtype=dtype)
        make = _new_value(kind.value_type)
        return lambda: [make() for _ in range(kind.size)]
    if isinstance(kind, idl.NamespacedType):
        return lambda: nested_class(kind)()
    if isinstance(kind, idl.BasicType):
        if kind.typename == "octet":
            return lambda: b"\0"
        return {"boolean": bool, "float": float, "double": float}.get(kind.typename, int)
    return str


def _field_property(owner: type, member: idl.Member) -> property:
    check = field_checks.checks(member.type, nested_class)
    is_array = field_checks.array_check(member.type)
    store = field_checks.stored(member.type)
    name, put = member.name, getattr(owner, f"_{member.name}").__set__

    def setter(self: Any, value: Any) -> None:
        if self._check_fields:
            if is_array is not None and is_array(name, value):
                put(self, value)
                return
            check(name, value)
        put(self, value if store is None else store(value))

    return property(operator.attrgetter(f"_{name}"), setter, doc=f"Message field '{name}'.")


def _repr(self: Any) -> str:
    path = self.__class__.__module__.split(".")[:-1]
    fields = []
    for name, kind in zip(self._fields_and_field_types, self.SLOT_TYPES, strict=True):
        value = getattr(self, name)
        text = repr(value)
        if field_checks.is_number_array(kind) and isinstance(kind, idl.AbstractSequence):
            text = text[len("array('X', ") : -1] if len(value) else "[]"
        fields.append(f"{name}={text}")
    return f"{'.'.join([*path, self.__class__.__name__])}({', '.join(fields)})"


def _equality(members: list[idl.Member]) -> Callable[[Any, object], bool]:
    arrays = {m.name for m in members if isinstance(m.type, idl.Array) and field_checks.is_number_array(m.type)}

    def __eq__(self: Any, other: object) -> bool:
        if not isinstance(other, self.__class__):
            return False
        for member in members:
            mine, others = getattr(self, member.name), getattr(other, member.name)
            if any(mine != others) if member.name in arrays else mine != others:
                return False
        return True

    return __eq__


def _get_fields_and_field_types(cls: Any) -> dict[str, str]:
    return copy(cls._fields_and_field_types)
