"""What the commands of a CMakeLists.txt say about a package: one method for each, `do_` and its name.

Source: cmake-commands(7), https://cmake.org/cmake/help/latest/manual/cmake-commands.7.html
Source: rosidl_cmake 4.6 (`rosidl_generate_interfaces.cmake`), ament_cmake_core 2.5 (`ament_package.cmake`)
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from gz_course.sim.ros.ament_cmake import installed_files
from gz_course.sim.ros.ament_cmake.errors import PackageError, at

INTERFACES = "rosidl_generate_interfaces"
# What `include(GNUInstallDirs)` sets.
_GNU_DIRECTORIES = {
    "CMAKE_INSTALL_BINDIR": "bin",
    "CMAKE_INSTALL_LIBDIR": "lib",
    "CMAKE_INSTALL_LIBEXECDIR": "libexec",
    "CMAKE_INSTALL_INCLUDEDIR": "include",
    "CMAKE_INSTALL_DATADIR": "share",
    "CMAKE_INSTALL_DATAROOTDIR": "share",
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


class Commands:
    """Follows one command after the other, of which `line` is the last; `variables` has the value of each variable."""

    def __init__(self, path: Path) -> None:
        self.lists = CMakeLists(path)
        self.path, self.folder = path, path.parent  # the file that is being read, and the folder of the package
        names = ("CMAKE_SOURCE_DIR", "CMAKE_CURRENT_SOURCE_DIR", "CMAKE_CURRENT_LIST_DIR", "PROJECT_SOURCE_DIR")
        self.variables = dict.fromkeys(names, str(path.parent))
        self.variables |= {"UNIX": "1", "CMAKE_INSTALL_PREFIX": "", "PYTHON_INSTALL_DIR": installed_files.PYTHON}
        self.variables |= _GNU_DIRECTORIES
        self.line = 0

    def do_project(self, values: list[str]) -> None:
        if not values:
            raise self.error("expected the name of the project in 'project()'")
        self.lists.project = values[0]
        self.variables |= {"PROJECT_NAME": values[0], "CMAKE_PROJECT_NAME": values[0]}

    def do_set(self, values: list[str]) -> None:
        if not values:
            raise self.error("expected the name of a variable in 'set()'")
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
            self.remark(f"'list({act} ...)' is passed over; of lists, only APPEND, PREPEND, REMOVE_ITEM, SORT are read")
        self.variables[name] = ";".join(held)

    def do_file(self, values: list[str]) -> None:
        if values[:1] not in (["GLOB"], ["GLOB_RECURSE"]) or len(values) < 3:
            self.remark(f"'file({values[0] if values else ''} ...)' is passed over; only 'file(GLOB ...)' is read")
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
            raise self.error(text)
        if kind in ("WARNING", "AUTHOR_WARNING", "DEPRECATION"):
            self.remark(text)

    def do_find_package(self, values: list[str]) -> None:
        if values:
            self.lists.found.setdefault(values[0], self.line)
            self.variables[f"{values[0]}_FOUND"] = "1"

    def do_rosidl_generate_interfaces(self, values: list[str]) -> None:
        lists = self.lists
        if "rosidl_default_generators" not in lists.found and not lists.finds_all:
            raise self.error(
                f"Unknown CMake command '{INTERFACES}'; write find_package(rosidl_default_generators REQUIRED) "
                "before it"
            )
        words = ("DEPENDENCIES", "LIBRARY_NAME", "ADD_LINTER_TESTS", "SKIP_INSTALL", "SKIP_GROUP_MEMBERSHIP_CHECK")
        parts = installed_files.by_keyword(values[1:], words)
        if not values or (values[0] != lists.project and values[0].endswith((".msg", ".srv", ".action"))):
            raise self.error("expected ${PROJECT_NAME} as the first argument of " + f"{INTERFACES}()")
        if not parts[""]:
            raise self.error(f"{INTERFACES}() called without any interface files")
        for file in parts[""]:
            lists.interfaces.setdefault(file, self.line)
        for package in parts.get("DEPENDENCIES", []):
            if package not in lists.found and not lists.finds_all:
                raise self.error(
                    f"{INTERFACES}() the passed dependency '{package}' has not been found before using "
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
            self.remark(f"'install({kind} ...)' is passed over: {error}")

    def do_ament_python_install_package(self, values: list[str]) -> None:
        if not values:
            raise self.error("expected the name of a Python package in 'ament_python_install_package()'")
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
            raise self.error("ament_package() must be called after project()")
        self.lists.package_line = self.line

    def do_ament_auto_find_build_dependencies(self, values: list[str]) -> None:
        self.lists.finds_all = True

    def do_ament_auto_package(self, values: list[str]) -> None:
        self.do_ament_package([])
        for folder in installed_files.by_keyword(values, ("INSTALL_TO_SHARE",)).get("INSTALL_TO_SHARE", []):
            share = f"share/{self.lists.project}"
            self.lists.files.append(installed_files.InstalledFiles(folder, share, self.line))

    def do_include(self, values: list[str]) -> None:
        """Pass over a module of CMake; the reader follows a file."""

    def lookup(self, name: str, kind: str) -> str:
        """Return the value of a variable, or with the kind `ENV` of one of the environment; empty if it has none."""
        if kind == "ENV":
            return os.environ.get(name, "")
        return self.variables.get(name, "")

    def remark(self, sentence: str) -> None:
        """Note a sentence about the present line."""
        self.lists.remarks.append(at(self.path, self.line, sentence))

    def error(self, sentence: str) -> PackageError:
        """Return the error that a sentence about the present line is."""
        return PackageError(sentence, self.path, self.line)


COMMANDS: dict[str, Callable[[Commands, list[str]], None]] = {
    name.removeprefix("do_"): act for name, act in vars(Commands).items() if name.startswith("do_")
}
