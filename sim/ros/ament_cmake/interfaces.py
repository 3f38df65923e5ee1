"""Checks the interfaces of a package before they are installed.

Source: rosidl_cmake 4.6 (`rosidl_generate_interfaces.cmake`)
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

from rosidl_parser import definition as idl

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.ament_cmake.cmake_commands import CMakeLists
from gz_course.sim.ros.ament_cmake.errors import PackageError, at
from gz_course.sim.ros.ament_cmake.package_manifest import PackageManifest, read_manifest
from gz_course.sim.ros.rosidl.errors import InvalidInterfaceError
from gz_course.sim.ros.rosidl.interface_text import KINDS, Interface, messages_of, nested_types, read_interface

_GROUP = "rosidl_interface_packages"
_BEHIND_EVERY = ("builtin_interfaces", "service_msgs", "action_msgs", "unique_identifier_msgs")


def interface_paths(lists: CMakeLists) -> dict[str, Path]:
    """Return the interfaces of a package: `msg/Name.msg` -> file. Raises PackageError."""
    folder = lists.path.parent
    found: dict[str, Path] = {}
    for written, line in lists.interfaces.items():
        base, colon, inner = written.rpartition(":")
        path = folder / base / inner if colon else folder / written
        kind = path.suffix.removeprefix(".")
        if kind not in KINDS:
            raise PackageError(f"'{written}' is not an interface; expected .msg, .srv or .action", lists.path, line)
        if not path.is_file():
            files = [each.relative_to(folder).as_posix() for kind in KINDS for each in folder.glob(f"{kind}/*.{kind}")]
            raise PackageError(
                f"rosidl_generate_interfaces() the passed file '{written}' doesn't exist relative to '{folder}'"
                + did_you_mean(written, files),
                lists.path,
                line,
            )
        if path.parent.name != kind:
            raise PackageError(f"'{written}' must be in a folder '{kind}', as '{kind}/{path.name}'", lists.path, line)
        found[f"{kind}/{path.name}"] = path
    return found


def check(lists: CMakeLists, manifest: PackageManifest, paths: dict[str, Path], prefixes: Sequence[Path]) -> list[str]:
    """Return all faults of the interfaces, each one sentence; remarks are added to those of `lists`."""
    line = next(iter(lists.interfaces.values()))
    faults = []
    if lists.in_interface_group and _GROUP not in manifest.groups:
        sentence = f"Packages installing interfaces must include '<member_of_group>{_GROUP}</member_of_group>'"
        faults.append(at(manifest.path, None, sentence))
    for package, where in lists.dependencies.items():
        if package not in manifest.dependencies:
            sentence = (
                f"'{package}' is not in package.xml, so the build fails where it is built later than this package; "
                f"add <depend>{package}</depend>"
            )
            lists.remarks.append(at(lists.path, where, sentence))
        if _share(package, prefixes) is None:
            hint = did_you_mean(package, _known(prefixes))
            faults.append(at(lists.path, where, f"the dependency '{package}' is not installed, nor built before{hint}"))
    read: dict[Path, Interface] = {}
    for path in paths.values():
        try:
            read[path] = read_interface(path, manifest.name)
        except InvalidInterfaceError as error:
            faults.append(str(error))
    allowed = _reachable((*lists.dependencies, *_BEHIND_EVERY), prefixes)
    scope = _Scope(manifest.name, {each.split("/")[1].split(".")[0] for each in paths if each.startswith("msg/")})
    for path, interface in read.items():
        faults += [at(path, number, text) for number, text in scope.faults(path, interface, allowed, prefixes, line)]
    return faults + _circles(manifest.name, {path: each for path, each in read.items() if path.suffix == ".msg"})


class _Scope:
    """The messages of the package itself, which its interfaces may use without DEPENDENCIES."""

    def __init__(self, package: str, messages: set[str]) -> None:
        self.package = package
        self.messages = messages

    def faults(
        self, path: Path, interface: Interface, allowed: dict[str, Path], prefixes: Sequence[Path], line: int
    ) -> Iterable[tuple[int | None, str]]:
        """Yield line and sentence for each type that does not exist or may not be used."""
        seen = set()
        for message in messages_of(interface):
            for kind in nested_types(message.structure.members):
                package, folder, name = kind.namespaced_name()
                if folder != "msg" or (package, name) in seen:
                    continue
                seen.add((package, name))
                number = _line_of(path, package, name)
                if package == self.package:
                    if name not in self.messages:
                        yield number, self._unknown(path, name, allowed, line)
                elif package not in allowed:
                    share = _share(package, prefixes)
                    if share is None:
                        hint = did_you_mean(package, _known(prefixes))
                        yield number, f"unknown package '{package}' in the type {package}/{name}{hint}"
                    else:
                        add = (
                            f"add find_package({package} REQUIRED) and DEPENDENCIES {package} to CMakeLists.txt:{line}"
                        )
                        yield number, f"the package '{package}' of {package}/{name} is not a dependency; {add}"
                elif name not in (names := _messages_in(allowed[package])):
                    hint = did_you_mean(name, names, listing=f"{package} has")
                    yield number, f"unknown type {package}/{name}{hint}"

    def _unknown(self, path: Path, name: str, allowed: dict[str, Path], line: int) -> str:
        sentence = f"unknown type {self.package}/{name}"
        if (path.parents[1] / "msg" / f"{name}.msg").is_file():
            return f'{sentence}; add "msg/{name}.msg" to rosidl_generate_interfaces() in CMakeLists.txt:{line}'
        for package, share in allowed.items():
            if package not in _BEHIND_EVERY and name in _messages_in(share):
                return f"{sentence}; did you mean '{package}/{name}'?"
        return sentence + did_you_mean(name, self.messages, listing=f"{self.package} has")


def _circles(package: str, messages: dict[Path, Interface]) -> list[str]:
    """Return a sentence if a message contains itself."""
    paths = {path.stem: path for path in messages}
    inner: dict[str, list[str]] = {}
    for path, message in messages.items():
        kinds = [kind.namespaced_name() for kind in nested_types(_members(message))]
        inner[path.stem] = [name for owner, folder, name in kinds if (owner, folder) == (package, "msg")]
    try:
        TopologicalSorter(inner).prepare()
    except CycleError as error:
        circle = error.args[1][::-1]
        path = paths[circle[0]]
        sentence = f"a message cannot contain itself: {' contains '.join(circle)}"
        return [at(path, _line_of(path, package, circle[1]), sentence)]
    return []


def _members(message: Interface) -> list[idl.Member]:
    return message.structure.members if isinstance(message, idl.Message) else []


def _reachable(packages: Iterable[str], prefixes: Sequence[Path]) -> dict[str, Path]:
    """Return these packages and all they need, with their share folders; what is not installed is left out."""
    found: dict[str, Path] = {}
    todo = list(packages)
    while todo:
        package = todo.pop()
        share = _share(package, prefixes) if package not in found else None
        if share is None:
            continue
        found[package] = share
        try:
            todo += read_manifest(share / "package.xml").dependencies
        except PackageError:
            continue
    return found


def _share(package: str, prefixes: Sequence[Path]) -> Path | None:
    shares = (prefix / "share" / package for prefix in prefixes)
    return next((share for share in shares if (share / "package.xml").is_file()), None)


def _known(prefixes: Sequence[Path]) -> set[str]:
    return {path.parent.name for prefix in prefixes for path in prefix.glob("share/*/package.xml")}


def _messages_in(share: Path) -> set[str]:
    return {path.stem for end in ("msg", "idl") for path in share.glob(f"msg/*.{end}")}


def _line_of(path: Path, package: str, name: str) -> int | None:
    """Return the first line of a text in which a type is used."""
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        words = line.partition("#")[0].split()
        if words and words[0].split("[")[0] in (name, f"{package}/{name}", f"{package}/msg/{name}"):
            return number
    return None
