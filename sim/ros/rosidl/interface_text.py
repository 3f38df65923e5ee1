"""Reads the text of an interface: `.msg`, `.srv` or `.action`.

The result are the objects of `rosidl_parser.definition`, as for the `.idl` files of a compiled package. Names and
values of a line are parsed by `rosidl_adapter`.

Source: "About ROS 2 interfaces", https://docs.ros.org/en/jazzy/Concepts/Basic/About-Interfaces.html
Source: rosidl_adapter 4.6 (`msg/__init__.py`: which IDL type stands for a type of a text)
"""

from __future__ import annotations

import keyword
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, TypeAlias

from rosidl_adapter import parser as adapter
from rosidl_parser import definition as idl

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.rosidl.errors import InvalidInterfaceError

KINDS = ("msg", "srv", "action")
"""Kinds of interfaces: the suffix of the file, its folder, and the middle part of the type's name."""

_SEPARATOR = "---"
_PARTS = {"msg": ("",), "srv": ("_Request", "_Response"), "action": ("_Goal", "_Result", "_Feedback")}
_PART_NAMES = {
    "srv": "request and response, separated by one line '---'",
    "action": "goal, result and feedback, separated by two lines '---'",
}
_BASIC = {
    **{name: name for sign in ("int", "uint") for bits in (8, 16, 32, 64) for name in [f"{sign}{bits}"]},
    **{"bool": "boolean", "byte": "octet", "char": "uint8", "float32": "float", "float64": "double"},
}
_STRINGS = {"string": (idl.UnboundedString, idl.BoundedString), "wstring": (idl.UnboundedWString, idl.BoundedWString)}
_PRIMITIVES = (*_BASIC, *_STRINGS)
# Field names for which the generated C++ or Python could not be compiled, and one that every message class has.
_RESERVED = {
    *keyword.kwlist,
    "check_fields",
    *("alignas", "alignof", "and_eq", "asm", "auto", "bitand", "bitor", "bool", "case", "catch", "char", "compl"),
    *("const", "constexpr", "decltype", "default", "delete", "do", "double", "dynamic_cast", "enum", "explicit"),
    *("export", "extern", "false", "float", "friend", "goto", "inline", "int", "long", "mutable", "namespace", "new"),
    *("noexcept", "not_eq", "nullptr", "operator", "or_eq", "private", "protected", "public", "register"),
    *("reinterpret_cast", "short", "signed", "sizeof", "static", "static_assert", "static_cast", "struct", "switch"),
    *("template", "this", "thread_local", "throw", "true", "typedef", "typeid", "typename", "union", "unsigned"),
    *("using", "virtual", "void", "volatile", "wchar_t", "xor", "xor_eq"),
}

Interface: TypeAlias = idl.Message | idl.Service | idl.Action


def read_interface(path: Path, package: str) -> Interface:
    """Return the definition in a file, whose suffix is the kind. Raises InvalidInterfaceError."""
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise InvalidInterfaceError(f"this is not a text in UTF-8: {error.reason}", path) from None
    except OSError as error:
        raise InvalidInterfaceError(f"the file cannot be read: {error.strerror}", path) from None
    return parse_interface(text, package, path.suffix.removeprefix("."), path.stem, path)


def parse_interface(text: str, package: str, kind: str, name: str, path: Path | str) -> Interface:
    """Return the definition that is called `package/kind/name`; `path` is named in errors."""
    if not adapter.is_valid_package_name(package):
        raise InvalidInterfaceError(
            f"'{package}' cannot be the name of a package; expected small letters, digits and single underscores", path
        )
    if not re.fullmatch("[A-Z][A-Za-z0-9]*", name):
        raise InvalidInterfaceError(
            f"'{name}' cannot be the name of an interface; expected letters and digits that begin with a capital", path
        )
    lines = list(enumerate(text.splitlines(), 1))
    cuts = [index for index, (_, line) in enumerate(lines) if line == _SEPARATOR] if kind != "msg" else []
    suffixes = _PARTS[kind]
    if len(cuts) != len(suffixes) - 1:
        raise InvalidInterfaceError(f"expected {_PART_NAMES[kind]}, found {len(cuts)} of these lines", path)
    edges = [-1, *cuts, len(lines)]
    messages = [
        _message(lines[start + 1 : end], idl.NamespacedType([package, kind], name + suffix), path)
        for start, end, suffix in zip(edges, edges[1:], suffixes, strict=False)
    ]
    if kind == "msg":
        return messages[0]
    whole = idl.NamespacedType([package, kind], name)
    return idl.Service(whole, *messages) if kind == "srv" else idl.Action(whole, *messages)


def messages_of(interface: Interface) -> Iterator[idl.Message]:
    """Yield every message of an interface, in an order in which each comes after those it contains."""
    if isinstance(interface, idl.Message):
        yield interface
    elif isinstance(interface, idl.Service):
        yield from (interface.request_message, interface.response_message, interface.event_message)
    else:
        yield from (interface.goal, interface.result, interface.feedback)
        yield from messages_of(interface.send_goal_service)
        yield from messages_of(interface.get_result_service)
        yield interface.feedback_message


def nested_types(members: Iterable[idl.Member]) -> Iterator[idl.NamespacedType]:
    """Yield the types of all fields that are messages, or arrays of messages."""
    for member in members:
        inner = member.type.value_type if isinstance(member.type, idl.AbstractNestedType) else member.type
        if isinstance(inner, idl.NamespacedType):
            yield inner


def _message(lines: list[tuple[int, str]], name: idl.NamespacedType, path: Path | str) -> idl.Message:
    message = idl.Message(idl.Structure(name))
    seen: dict[str, int] = {}
    for number, raw in lines:
        words = raw.replace("\t", " ").partition("#")[0].strip().split(" ", 1)
        if words == [""]:
            continue
        try:
            item = _item(words[0], words[1].strip() if len(words) > 1 else "", name.namespaces[0])
        except _Expected as error:
            raise InvalidInterfaceError(str(error), path, number) from None
        if item.name in seen:
            raise InvalidInterfaceError(
                f"the name '{item.name}' is already used in line {seen[item.name]}", path, number
            )
        seen[item.name] = number
        (message.structure.members if isinstance(item, idl.Member) else message.constants).append(item)
    if not message.structure.members:
        empty = idl.Member(idl.BasicType("uint8"), idl.EMPTY_STRUCTURE_REQUIRED_MEMBER_NAME)
        message.structure.members.append(empty)
    return message


class _Expected(Exception):
    """A line that is not what was expected."""


def _item(type_text: str, rest: str, package: str) -> idl.Member | idl.Constant:
    """Return the field or constant of one line."""
    if not rest:
        raise _Expected(f"expected a type and a name, found only '{type_text}'")
    name, equals, value = rest.partition("=")
    if equals:
        return _constant(type_text, name.strip(), value.strip())
    name, _, default = rest.partition(" ")
    kind = _adapted_type(type_text, package)
    if name.endswith("]") and adapter.is_valid_field_name(name.partition("[")[0]):
        field, _, size = name.partition("[")
        raise _Expected(f"the brackets of an array belong to its type: {type_text}[{size} {field}")
    if not adapter.is_valid_field_name(name):
        raise _Expected(
            f"'{name}' cannot be the name of a field; expected small letters, digits and single underscores, "
            "beginning with a letter"
        )
    if name in _RESERVED:
        raise _Expected(f"'{name}' is a reserved word and cannot be the name of a field; choose another name")
    member = idl.Member(_idl_type(kind), name)
    if default := default.strip():
        value = _parsed(adapter.parse_value_string, kind, default)
        member.annotations.append(idl.Annotation("default", {"value": _as_idl(kind, value)}))
    return member


def _constant(type_text: str, name: str, value: str) -> idl.Constant:
    if type_text not in _PRIMITIVES:
        raise _Expected(f"a constant has one of the types {', '.join(_PRIMITIVES)}, not '{type_text}'")
    if not adapter.is_valid_constant_name(name):
        raise _Expected(f"'{name}' cannot be the name of a constant; expected capitals, digits and single underscores")
    kind = adapter.Type(type_text)
    if not value and type_text not in _STRINGS:
        raise _Expected(f"expected the value of the constant {name} after '='")
    parsed = _as_idl(kind, _parsed(adapter.parse_primitive_value_string, kind, value))
    return idl.Constant(name, _idl_type(kind), parsed)


def _adapted_type(text: str, package: str) -> adapter.Type:
    """Return the type written in a text. Raises _Expected with the nearest name."""
    base = re.split(r"\[|<=", text)[0]
    if text.endswith(":"):
        raise _Expected(f"'{text}' is not a type: the type comes first, then the name, without a colon")
    if re.fullmatch(r"\w+/(msg|srv|action)/\w+", base):
        package, _, name = base.split("/")
        raise _Expected(
            f"'{text}' is not a type: write {package}/{name}{text[len(base) :]}, without the folder between them"
        )
    if base[:1].islower() and "/" not in base and base not in _PRIMITIVES:
        raise _Expected(f"unknown type '{base}'" + (did_you_mean(base, _PRIMITIVES) or _shapes()))
    try:
        return adapter.Type(text, context_package_name=package)
    except Exception:
        raise _Expected(f"'{text}' is not a type{_shapes()}") from None


def _shapes() -> str:
    return "; expected a plain type, Name or package/Name, and for arrays [], [5] or [<=5]"


def _parsed(parse: Any, kind: adapter.Type, text: str) -> Any:
    """Return a default or constant value. Whatever the parser raises becomes a sentence."""
    try:
        return parse(kind, text)
    except NotImplementedError:
        raise _Expected(f"a field of type '{kind}' has no default value, found '{text}'") from None
    except Exception as error:
        raise _Expected(str(error) or f"'{text}' is not a value of type '{kind}'") from None


def _as_idl(kind: adapter.Type, value: Any) -> Any:
    """Return a value as it is read again from an `.idl` file: escapes are resolved, a sequence is a text."""
    if kind.is_array:
        return repr(tuple(value))
    if isinstance(value, str):
        try:
            return value.encode().decode("unicode_escape").encode("latin-1").decode()
        except UnicodeError:
            return value
    return value


def _idl_type(kind: adapter.Type) -> idl.AbstractType:
    inner: idl.AbstractNestableType
    if kind.type in _STRINGS and kind.is_primitive_type():
        unbounded, bounded = _STRINGS[kind.type]
        inner = bounded(kind.string_upper_bound) if kind.string_upper_bound else unbounded()
    elif kind.is_primitive_type():
        inner = idl.BasicType(_BASIC[kind.type])
    else:
        inner = idl.NamespacedType([kind.pkg_name, "msg"], kind.type)
    if kind.is_fixed_size_array():
        return idl.Array(inner, kind.array_size)
    if kind.is_upper_bound:
        return idl.BoundedSequence(inner, kind.array_size)
    if kind.is_array and isinstance(inner, idl.BoundedWString):
        # ROS takes the bound of the texts for that of the sequence, too (rosidl_parser 4.6): hashes depend on it.
        return idl.BoundedSequence(inner, inner.maximum_size)
    return idl.UnboundedSequence(inner) if kind.is_array else inner
