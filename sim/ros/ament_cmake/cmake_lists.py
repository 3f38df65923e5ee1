"""Reads what a CMakeLists.txt says about interfaces, Python modules and installed files.

Commands for compilers have no effect. Every other command gets a remark; so does a condition that is not understood.

Source: cmake-commands(7), https://cmake.org/cmake/help/latest/manual/cmake-commands.7.html
Source: rosidl_cmake 4.6 (`rosidl_generate_interfaces.cmake`), ament_cmake_core 2.5 (`ament_package.cmake`)
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from gz_course.sim.did_you_mean import nearest_name
from gz_course.sim.ros.ament_cmake import installed_files
from gz_course.sim.ros.ament_cmake.cmake_text import Command, commands_of, values_of
from gz_course.sim.ros.ament_cmake.condition import UnknownConditionError, holds
from gz_course.sim.ros.ament_cmake.errors import PackageError, at

_INTERFACES = "rosidl_generate_interfaces"
_COMPILED = ("add_executable", "add_library", "rclcpp_components_register_node", "rclcpp_components_register_nodes")
_BLOCKS = {"foreach": "endforeach", "while": "endwhile", "function": "endfunction", "macro": "endmacro"}
_MOST_STEPS = 100_000  # commands, those in loops each time
# What `include(GNUInstallDirs)` sets.
_GNU_DIRECTORIES = {
    "CMAKE_INSTALL_BINDIR": "bin",
    "CMAKE_INSTALL_LIBDIR": "lib",
    "CMAKE_INSTALL_LIBEXECDIR": "libexec",
    "CMAKE_INSTALL_INCLUDEDIR": "include",
    "CMAKE_INSTALL_DATADIR": "share",
    "CMAKE_INSTALL_DATAROOTDIR": "share",
}
# They say how to compile, link, test and export, or only change what others of them do.
_WITHOUT_EFFECT = {
    *("cmake_minimum_required", "cmake_policy", "enable_language", "enable_testing", "mark_as_advanced"),
    *("add_compile_options", "add_compile_definitions", "add_definitions", "add_dependencies", "add_link_options"),
    *("include_directories", "link_directories", "link_libraries", "set_property", "set_target_properties"),
    *("target_compile_definitions", "target_compile_features", "target_compile_options", "target_include_directories"),
    *("target_link_directories", "target_link_libraries", "target_link_options", "target_sources"),
    *("ament_target_dependencies", "rosidl_target_interfaces", "rosidl_get_typesupport_target"),
    *("ament_export_dependencies", "ament_export_include_directories", "ament_export_interfaces"),
    *("ament_export_libraries", "ament_export_targets", "ament_export_definitions", "ament_export_link_flags"),
    *("ament_package_xml", "ament_lint_auto_find_test_dependencies", "find_package_handle_standard_args"),
}


@dataclass
class CMakeLists:
    """What the file of one package says. Paths of interfaces are as written; `line` is where something stands."""

    path: Path
    project: str = ""
    found: dict[str, int] = field(default_factory=dict)
    finds_all: bool = False  # every dependency in package.xml counts as found
    interfaces: dict[str, int] = field(default_factory=dict)
    dependencies: dict[str, int] = field(default_factory=dict)
    in_interface_group: bool = True
    files: list[installed_files.InstalledFiles] = field(default_factory=list)
    python_packages: dict[str, int] = field(default_factory=dict)
    hooks: list[installed_files.Hook] = field(default_factory=list)
    package_line: int = 0
    remarks: list[str] = field(default_factory=list)


def read_cmake_lists(path: Path) -> CMakeLists:
    """Return what a file says. Raises PackageError."""
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise PackageError(f"this is not a text in UTF-8: {error.reason}", path) from None
    except OSError as error:
        raise PackageError(f"the file cannot be read: {error.strerror}", path) from None
    reader = _Reader(path)
    reader.run(commands_of(text, path))
    return reader.lists


def _body(commands: Sequence[Command], start: int) -> Sequence[Command]:
    """Return the commands between a `foreach()` and its end."""
    depth = 0
    for index in range(start, len(commands)):
        depth += (commands[index].name == "foreach") - (commands[index].name == "endforeach")
        if not depth:
            return commands[start + 1 : index]
    return []  # without an end; `run` reports it


class _Reader:
    """Follows the commands of one file; `variables` has the value of each variable."""

    def __init__(self, path: Path) -> None:
        self.lists = CMakeLists(path)
        self.folder = path.parent
        names = ("CMAKE_SOURCE_DIR", "CMAKE_CURRENT_SOURCE_DIR", "CMAKE_CURRENT_LIST_DIR", "PROJECT_SOURCE_DIR")
        self.variables = dict.fromkeys(names, str(path.parent))
        self.variables |= {"UNIX": "1", "CMAKE_INSTALL_PREFIX": "", "PYTHON_INSTALL_DIR": installed_files.PYTHON}
        self.variables |= _GNU_DIRECTORIES
        self.line = 0
        self.steps = 0

    def run(self, commands: Sequence[Command]) -> bool:
        """Follow the commands; return whether `return()` has ended them.

        The list `branches` has the open `if()`: whether a branch was taken, and its line.
        """
        branches: list[tuple[bool, bool, int]] = []  # taken before or now, now, line
        block = ("", 0)  # what ends the block that is passed over, and how many of these are open
        for index, command in enumerate(commands):
            self.line, name = command.line, command.name
            self.steps += 1
            if self.steps > _MOST_STEPS:
                raise self._error(f"the loops of this file go on after {_MOST_STEPS} commands")
            if block[1]:
                opens, closes = name in _BLOCKS and _BLOCKS[name] == block[0], name == block[0]
                block = (block[0], block[1] + opens - closes)
                continue
            active = all(now for _, now, _ in branches)
            if name == "if":
                now = active and self._holds(command)
                branches.append((now or not active, now, command.line))
            elif name in ("elseif", "else", "endif"):
                if not branches:
                    raise self._error(f"'{name}()' stands after no 'if()'")
                taken, _, line = branches.pop()
                if name != "endif":
                    now = not taken and (name == "else" or self._holds(command))
                    branches.append((taken or now, now, line))
            elif name in _BLOCKS:
                block = (_BLOCKS[name], 1)
                if active and name == "foreach":
                    if self._repeat(command, _body(commands, index)):
                        return True
                elif active:
                    self._remark(f"what stands in '{name}()' is passed over; write it without '{name}()'")
            elif active:
                if name == "return":
                    return True
                self._do(command)
        if block[1]:
            raise PackageError(f"expected '{block[0]}()' before the end of the file", self.lists.path)
        if branches:
            raise PackageError("this 'if()' has no 'endif()'", self.lists.path, branches[-1][2])
        return False

    def _repeat(self, command: Command, body: Sequence[Command]) -> bool:
        """Follow the commands of a `foreach()` for each of its items; return whether `return()` has ended them."""
        values = values_of(command.arguments, self._lookup)
        items = self._items(values[1:])
        if not values or items is None:
            self._remark(
                "this form of 'foreach()' is ignored; write 'foreach(NAME ITEM...)', or IN with LISTS or ITEMS"
            )
            return False
        before = self.variables.get(values[0])
        for item in items:
            self.variables[values[0]] = item
            if self.run(body):
                return True
        if before is None:
            self.variables.pop(values[0], None)
        else:
            self.variables[values[0]] = before
        return False

    def _items(self, words: list[str]) -> list[str] | None:
        """Return what a `foreach()` goes through; None for a form that is not read."""
        if words[:1] == ["RANGE"] or "ZIP_LISTS" in words:
            return None
        if words[:1] != ["IN"]:
            return words
        parts = installed_files.by_keyword(words[1:], ("LISTS", "ITEMS"))
        held = [item for name in parts.get("LISTS", []) for item in self.variables.get(name, "").split(";") if item]
        return held + parts.get("ITEMS", [])

    def _do(self, command: Command) -> None:
        name, values = command.name, values_of(command.arguments, self._lookup)
        if self.lists.package_line:
            if name == _INTERFACES:
                raise self._error(f"{_INTERFACES}() must be called before ament_package()")
            if name in ("install", "ament_python_install_package"):
                raise self._error(f"{name}() must be called before ament_package()")
        if act := _COMMANDS.get(name):
            act(self, values)
        elif name in _COMPILED:
            what = f" '{values[0]}'" if values else ""
            self._remark(f"{name}(){what} is not built: that needs a compiler and an installed ament_cmake")
        elif name not in _WITHOUT_EFFECT:
            near = nearest_name(name, (*_COMMANDS, *_WITHOUT_EFFECT, *_COMPILED), cutoff=0.85)
            if near:
                raise self._error(f"Unknown CMake command '{name}'; did you mean '{near}'?")
            self._remark(
                f"'{name}()' is passed over: without an installed ament_cmake, only what interfaces, Python modules "
                "and installed files need is read"
            )

    def do_project(self, values: list[str]) -> None:
        if not values:
            raise self._error("expected the name of the project in 'project()'")
        self.lists.project = values[0]
        self.variables |= {"PROJECT_NAME": values[0], "CMAKE_PROJECT_NAME": values[0]}

    def do_set(self, values: list[str]) -> None:
        if not values:
            raise self._error("expected the name of a variable in 'set()'")
        name, *rest = values
        if "CACHE" in rest:
            rest = rest[: rest.index("CACHE")]
            if name in self.variables:
                return
        elif rest and rest[-1] == "PARENT_SCOPE":
            return
        if rest:
            self.variables[name] = ";".join(rest)
        else:
            self.variables.pop(name, None)

    def do_unset(self, values: list[str]) -> None:
        for name in values[:1]:
            self.variables.pop(name, None)

    def do_option(self, values: list[str]) -> None:
        if values and values[0] != "BUILD_TESTING":
            self.variables.setdefault(values[0], values[2] if len(values) > 2 else "OFF")

    def do_list(self, values: list[str]) -> None:
        act, name, *items = [*values, "", ""][: max(len(values), 2)]
        held = [each for each in self.variables.get(name, "").split(";") if each]
        if act == "APPEND":
            held += items
        elif act == "PREPEND":
            held = [*items, *held]
        elif act == "REMOVE_ITEM":
            held = [each for each in held if each not in items]
        elif act == "REMOVE_DUPLICATES":
            held = [*dict.fromkeys(held)]
        elif act == "SORT":
            held.sort()
        else:
            self._remark(
                f"'list({act} ...)' is passed over; of lists, only APPEND, PREPEND, REMOVE_ITEM, SORT are read"
            )
        self.variables[name] = ";".join(held)

    def do_file(self, values: list[str]) -> None:
        if values[:1] not in (["GLOB"], ["GLOB_RECURSE"]) or len(values) < 3:
            self._remark(f"'file({values[0] if values else ''} ...)' is passed over; only 'file(GLOB ...)' is read")
            return
        act, name, *rest = values
        relative = ""
        if rest[:1] == ["RELATIVE"]:
            relative, rest = rest[1], rest[2:]
        patterns = [each for each in rest if each != "CONFIGURE_DEPENDS"]
        found: set[str] = set()
        for pattern in patterns:
            start = self.folder if not Path(pattern).is_absolute() else Path("/")
            pattern = pattern.lstrip("/")
            paths = start.rglob(pattern) if act == "GLOB_RECURSE" else start.glob(pattern)
            found |= {os.path.relpath(each, relative) if relative else str(each) for each in paths}
        self.variables[name] = ";".join(sorted(found))

    def do_message(self, values: list[str]) -> None:
        kind, text = (values[0], "".join(values[1:])) if values else ("", "")
        if kind in ("FATAL_ERROR", "SEND_ERROR"):
            raise self._error(text)
        if kind in ("WARNING", "AUTHOR_WARNING", "DEPRECATION"):
            self._remark(text)

    def do_find_package(self, values: list[str]) -> None:
        if values:
            self.lists.found.setdefault(values[0], self.line)
            self.variables[f"{values[0]}_FOUND"] = "1"

    def do_rosidl_generate_interfaces(self, values: list[str]) -> None:
        lists = self.lists
        if "rosidl_default_generators" not in lists.found and not lists.finds_all:
            raise self._error(
                f"Unknown CMake command '{_INTERFACES}'; write find_package(rosidl_default_generators REQUIRED) "
                "before it"
            )
        words = ("DEPENDENCIES", "LIBRARY_NAME", "ADD_LINTER_TESTS", "SKIP_INSTALL", "SKIP_GROUP_MEMBERSHIP_CHECK")
        parts = installed_files.by_keyword(values[1:], words)
        if not values or (values[0] != lists.project and values[0].endswith((".msg", ".srv", ".action"))):
            raise self._error("expected ${PROJECT_NAME} as the first argument of " + f"{_INTERFACES}()")
        if not parts[""]:
            raise self._error(f"{_INTERFACES}() called without any interface files")
        for file in parts[""]:
            lists.interfaces.setdefault(file, self.line)
        for package in parts.get("DEPENDENCIES", []):
            if package not in lists.found and not lists.finds_all:
                raise self._error(
                    f"{_INTERFACES}() the passed dependency '{package}' has not been found before using "
                    f"find_package(); write find_package({package} REQUIRED) before it"
                )
            lists.dependencies.setdefault(package, self.line)
        lists.in_interface_group &= "SKIP_GROUP_MEMBERSHIP_CHECK" not in parts

    def do_install(self, values: list[str]) -> None:
        kind = values[0] if values else ""
        if kind in ("TARGETS", "EXPORT"):
            return
        try:
            self.lists.files += installed_files.read(values, self.line)
        except installed_files.UnknownFormError as error:
            self._remark(f"'install({kind} ...)' is passed over: {error}")

    def do_ament_python_install_package(self, values: list[str]) -> None:
        if not values:
            raise self._error("expected the name of a Python package in 'ament_python_install_package()'")
        parts = installed_files.by_keyword(values[1:], ("PACKAGE_DIR", "VERSION", "SETUP_CFG", "DESTINATION"))
        folder = (*parts.get("PACKAGE_DIR", ()), values[0])[0]
        self.lists.python_packages[values[0]] = self.line
        self.lists.files.append(
            installed_files.InstalledFiles(f"{folder.rstrip('/')}/", f"{installed_files.PYTHON}/{values[0]}", self.line)
        )

    def do_ament_environment_hooks(self, values: list[str]) -> None:
        self.lists.hooks += [installed_files.Hook(value, self.line, dict(self.variables)) for value in values]

    def do_ament_package(self, values: list[str]) -> None:
        if not self.lists.project:
            raise self._error("ament_package() must be called after project()")
        self.lists.package_line = self.line

    def do_ament_auto_find_build_dependencies(self, values: list[str]) -> None:
        self.lists.finds_all = True

    def do_ament_auto_package(self, values: list[str]) -> None:
        self.do_ament_package([])
        for folder in installed_files.by_keyword(values, ("INSTALL_TO_SHARE",)).get("INSTALL_TO_SHARE", []):
            share = f"share/{self.lists.project}"
            self.lists.files.append(installed_files.InstalledFiles(folder, share, self.line))

    def do_include(self, values: list[str]) -> None:
        if values and values[0].endswith(".cmake"):
            self._remark(f"'include({values[0]})' is passed over; write into this file what interfaces need")

    def _holds(self, command: Command) -> bool:
        try:
            return holds(command.arguments, self.variables, self._lookup)
        except UnknownConditionError as error:
            self._remark(
                f"the condition of '{command.name}()' is not understood at '{error}'; its branch is passed over"
            )
            return False

    def _lookup(self, name: str, kind: str) -> str:
        if kind == "ENV":
            return os.environ.get(name, "")
        return self.variables.get(name, "")

    def _remark(self, sentence: str) -> None:
        self.lists.remarks.append(at(self.lists.path, self.line, sentence))

    def _error(self, sentence: str) -> PackageError:
        return PackageError(sentence, self.lists.path, self.line)


_COMMANDS: dict[str, Callable[[_Reader, list[str]], None]] = {
    name.removeprefix("do_"): act for name, act in vars(_Reader).items() if name.startswith("do_")
}
