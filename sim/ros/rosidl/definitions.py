"""The definitions of interfaces by name: of those made at run time from their texts, of compiled ones from their files.

A definition is only given out when every type in it exists and no message contains itself.
"""

from __future__ import annotations

import functools
import json
from pathlib import Path

from rosidl_parser import definition as idl

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.rosidl import packages
from gz_course.sim.ros.rosidl.errors import InvalidInterfaceError
from gz_course.sim.ros.rosidl.interface_text import Interface, messages_of, nested_types, read_interface
from gz_course.sim.ros.rosidl.type_description import Description, full_description, individual_descriptions


@functools.cache
def definition(path: Path, package: str) -> Interface:
    """Return the definition in a file. Raises InvalidInterfaceError, also for types that do not exist."""
    interface = read_interface(path, package)
    for message in messages_of(interface):
        for kind in nested_types(message.structure.members):
            _check_exists(kind, interface, path)
    _check_not_in_itself(path, interface, ())
    return interface


def description(name: str) -> Description:
    """Return the full description of `package/kind/Name`, which may be a part of a service or an action."""
    return full_description(name, _known(name))


@functools.cache
def _known(name: str) -> dict[str, Description]:
    """Return the individual descriptions of a type and of all types it refers to, by name."""
    found: dict[str, Description] = {}
    seen: set[str] = set()
    todo = [name]
    while todo:
        here = todo.pop()
        if here in seen:
            continue
        seen.add(here)
        if here not in found:
            found |= _descriptions_with(here)
        nested = [field["type"]["nested_type_name"] for field in found[here]["fields"]]
        todo += [each for each in nested if each]
    return found


def _descriptions_with(name: str) -> dict[str, Description]:
    """Return the individual descriptions in the file that defines a type."""
    package, kind, part = name.split("/")
    path = _file(package, kind, part if kind == "msg" else part.split("_")[0])
    if package in packages.packages():
        return {each["type_name"]: each for each in individual_descriptions(definition(path, package))}
    message = json.loads(path.with_suffix(".json").read_text(encoding="utf-8"))["type_description_msg"]
    every = (message["type_description"], *message["referenced_type_descriptions"])
    return {each["type_name"]: each for each in every}


def _file(package: str, kind: str, name: str) -> Path:
    prefix = packages.packages(packages.ALL)[package]
    return Path(packages.share_folder(prefix, package), kind, f"{name}.{kind}")


def _check_exists(kind: idl.NamespacedType, interface: Interface, path: Path) -> None:
    package, folder, name = kind.namespaced_name()
    own = path.parents[1]
    if package == own.name:
        if folder != "msg":  # made from the text itself
            return
        files = own / "msg"
    else:
        known = packages.packages(packages.ALL)
        if package not in known:
            sentence = f"unknown package '{package}' in the type {package}/{name}{did_you_mean(package, known)}"
            raise InvalidInterfaceError(sentence, path, _line_of(path, name))
        files = Path(packages.share_folder(known[package], package), "msg")
    if not (files / f"{name}.msg").is_file() and not (files / f"{name}.idl").is_file():
        names = [each.stem for each in files.glob("*.msg")]
        sentence = f"unknown type {package}/{name}" + did_you_mean(name, names, listing=f"{package} has")
        raise InvalidInterfaceError(sentence, path, _line_of(path, name))


def _check_not_in_itself(path: Path, interface: Interface, above: tuple[Path, ...]) -> None:
    """Fail if a message contains a message that contains it."""
    if path in above:
        chain = " contains ".join(each.stem for each in (*above[above.index(path) :], path))
        raise InvalidInterfaceError(f"a message cannot contain itself: {chain}", path, _line_of(path, above[-1].stem))
    marked = packages.packages()
    for message in messages_of(interface):
        for kind in nested_types(message.structure.members):
            package, folder, name = kind.namespaced_name()
            share = path.parents[1] if package == path.parents[1].name else None
            if share is None and package in marked:
                share = Path(packages.share_folder(marked[package], package))
            nested = share / "msg" / f"{name}.msg" if share and folder == "msg" else None
            if nested is not None and nested.is_file():
                inner = _read(nested, package)
                _check_not_in_itself(nested, inner, (*above, path))


@functools.cache
def _read(path: Path, package: str) -> Interface:
    return read_interface(path, package)


def _line_of(path: Path, name: str) -> int | None:
    """Return the first line of a text in which a type is used."""
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        words = line.partition("#")[0].split()
        if words and words[0].split("[")[0].split("/")[-1] == name:
            return number
    return None
