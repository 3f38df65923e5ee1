"""Reads what a CMakeLists.txt says about interfaces, Python modules and installed files.

Commands for compilers have no effect. Every other command gets a remark; so does a condition that is not understood.

Source: cmake-commands(7), https://cmake.org/cmake/help/latest/manual/cmake-commands.7.html
Source: rosidl_cmake 4.6 (`rosidl_generate_interfaces.cmake`), ament_cmake_core 2.5 (`ament_package.cmake`)
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from gz_course.sim.did_you_mean import nearest_name
from gz_course.sim.ros.ament_cmake import installed_files
from gz_course.sim.ros.ament_cmake.cmake_commands import COMMANDS, INTERFACES, CMakeLists, Commands
from gz_course.sim.ros.ament_cmake.cmake_text import Command, commands_of, values_of
from gz_course.sim.ros.ament_cmake.condition import UnknownConditionError, holds
from gz_course.sim.ros.ament_cmake.errors import PackageError

_COMPILED = ("add_executable", "add_library", "rclcpp_components_register_node", "rclcpp_components_register_nodes")
_BLOCKS = {"foreach": "endforeach", "while": "endwhile", "function": "endfunction", "macro": "endmacro"}
_MOST_INCLUDES = 50
_MOST_STEPS = 100_000  # commands, those in loops each time
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


def read_cmake_lists(path: Path) -> CMakeLists:
    """Return what a file says. Raises PackageError."""
    reader = _Reader(path)
    reader.run(commands_of(text_of(path), path))
    return reader.lists


def text_of(path: Path) -> str:
    """Return the text of a file. Raises PackageError."""
    try:
        return path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise PackageError(f"this is not a text in UTF-8: {error.reason}", path) from None
    except OSError as error:
        raise PackageError(f"the file cannot be read: {error.strerror}", path) from None


def _body(commands: Sequence[Command], start: int) -> Sequence[Command]:
    """Return the commands between a `foreach()` and its end."""
    depth = 0
    for index in range(start, len(commands)):
        depth += (commands[index].name == "foreach") - (commands[index].name == "endforeach")
        if not depth:
            return commands[start + 1 : index]
    return []  # without an end; `run` reports it


class _Reader(Commands):
    """Follows the commands of one file: its conditions and its loops, and what stands in them."""

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        self.steps = 0
        self.depth = 0  # of the files that include each other

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
                raise self.error(f"the loops of this file go on after {_MOST_STEPS} commands")
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
                    raise self.error(f"'{name}()' stands after no 'if()'")
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
                    self.remark(f"what stands in '{name}()' is passed over; write it without '{name}()'")
            elif active:
                if name == "return":
                    return True
                self._do(command)
        if block[1]:
            raise PackageError(f"expected '{block[0]}()' before the end of the file", self.path)
        if branches:
            raise PackageError("this 'if()' has no 'endif()'", self.path, branches[-1][2])
        return False

    def _repeat(self, command: Command, body: Sequence[Command]) -> bool:
        """Follow the commands of a `foreach()` for each of its items; return whether `return()` has ended them."""
        values = values_of(command.arguments, self.lookup)
        items = self._items(values[1:])
        if not values or items is None:
            self.remark("this form of 'foreach()' is ignored; write 'foreach(NAME ITEM...)', or IN with LISTS or ITEMS")
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

    def _include(self, path: Path, *, optional: bool) -> None:
        """Follow the commands of another file, with the same variables."""
        if not path.is_file():
            if optional:
                return
            raise self.error(f"include could not find the file '{path}'")
        self.depth += 1
        if self.depth > _MOST_INCLUDES:
            raise self.error(f"this file includes itself: '{path}'")
        here = self.path, self.line, self.variables["CMAKE_CURRENT_LIST_DIR"]
        self.path, self.variables["CMAKE_CURRENT_LIST_DIR"] = path, str(path.parent)
        self.run(commands_of(text_of(path), path))
        self.path, self.line, self.variables["CMAKE_CURRENT_LIST_DIR"] = here
        self.depth -= 1

    def _do(self, command: Command) -> None:
        name, values = command.name, values_of(command.arguments, self.lookup)
        if name == "include" and values and values[0].endswith(".cmake"):
            self._include(self.folder / values[0], optional="OPTIONAL" in values)
            return
        if self.lists.package_line:
            if name == INTERFACES:
                raise self.error(f"{INTERFACES}() must be called before ament_package()")
            if name == "ament_python_install_package":
                raise self.error(f"{name}() must be called before ament_package()")
        if act := COMMANDS.get(name):
            act(self, values)
        elif name in _COMPILED:
            what = f" '{values[0]}'" if values else ""
            self.remark(f"{name}(){what} is not built: that needs a compiler and an installed ament_cmake")
        elif name not in _WITHOUT_EFFECT:
            near = nearest_name(name, (*COMMANDS, *_WITHOUT_EFFECT, *_COMPILED), cutoff=0.85)
            if near:
                raise self.error(f"Unknown CMake command '{name}'; did you mean '{near}'?")
            self.remark(
                f"'{name}()' is passed over: without an installed ament_cmake, only what interfaces, Python modules "
                "and installed files need is read"
            )

    def _holds(self, command: Command) -> bool:
        try:
            return holds(command.arguments, self.variables, self.lookup)
        except UnknownConditionError as error:
            self.remark(
                f"the condition of '{command.name}()' is not understood at '{error}'; its branch is passed over"
            )
            return False
