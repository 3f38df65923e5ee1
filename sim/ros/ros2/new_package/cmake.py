"""The files of a package of build type `ament_cmake` or `cmake`: CMakeLists.txt, a program and a library in C++."""

from __future__ import annotations

from collections.abc import Sequence


def files(
    name: str, dependencies: Sequence[str], *, ament: bool, interfaces: bool, node: str, library: str
) -> dict[str, str]:
    """Return the content of each file by its path."""
    made = {"CMakeLists.txt": _cmake_lists(name, dependencies, ament, interfaces, node, library)}
    if node:
        made[f"src/{node}.cpp"] = _program(name, library)
    if library:
        kind = _class_name(library)
        macro = name.upper()
        words = {"name": name, "library": library, "kind": kind, "macro": macro}
        made[f"include/{name}/{library}.hpp"] = _HEADER.format(guard=f"{macro}__{library.upper()}_HPP_", **words)
        made[f"include/{name}/visibility_control.h"] = _VISIBILITY.format(macro=macro)
        made[f"src/{library}.cpp"] = _LIBRARY.format(**words)
    if not ament:
        made[f"{name}Config.cmake.in"] = _CONFIG.format(name=name, library=library) if library else _EMPTY_CONFIG
    return made


def _class_name(library: str) -> str:
    return "".join(word.capitalize() for word in library.split("_"))


def _program(name: str, library: str) -> str:
    include = f'#include "{name}/{library}.hpp"\n' if library else ""
    use = f"  {name}::{_class_name(library)} made;\n  (void) made;\n" if library else ""
    return (
        f"#include <cstdio>\n{include}\nint main()\n{{\n{use}"
        f'  std::printf("hello world {name} package\\n");\n  return 0;\n}}\n'
    )


def _cmake_lists(name: str, dependencies: Sequence[str], ament: bool, interfaces: bool, node: str, library: str) -> str:
    tools = [*(["ament_cmake"] if ament else []), *(["ament_cmake_ros"] if ament and library else [])]
    lines = ["cmake_minimum_required(VERSION 3.8)", f"project({name})", "", "# find dependencies"]
    lines += [f"find_package({each} REQUIRED)" for each in (*tools, *dependencies)]
    if not dependencies:
        lines += ["# for each package that this one needs:", "# find_package(<dependency> REQUIRED)"]
    if interfaces:
        others = [each for each in dependencies if not each.startswith("rosidl_")]
        lines += ["", "# the files of your own messages, services and actions:"]
        lines += ["# rosidl_generate_interfaces(${PROJECT_NAME}", '#   "msg/Example.msg"']
        lines += [*([f"#   DEPENDENCIES {' '.join(others)}"] if others else []), "# )"]
    needs = " ".join(dependencies)
    if library:
        lines += ["", f"add_library({library} src/{library}.cpp)"]
        lines.append(f"target_compile_definitions({library} PRIVATE {name.upper()}_BUILDING_LIBRARY)")
        places = f"$<BUILD_INTERFACE:${{CMAKE_CURRENT_SOURCE_DIR}}/include> $<INSTALL_INTERFACE:include/{name}>"
        lines.append(f"target_include_directories({library} PUBLIC {places})")
        if ament and needs:
            lines.append(f"ament_target_dependencies({library} {needs})")
        lines += [f"install(DIRECTORY include/ DESTINATION include/{name})", f"install(TARGETS {library}"]
        lines += [f"  EXPORT export_{name}", "  ARCHIVE DESTINATION lib", "  LIBRARY DESTINATION lib"]
        lines.append("  RUNTIME DESTINATION bin)")
    if node:
        lines += ["", f"add_executable({node} src/{node}.cpp)"]
        if ament and needs:
            lines.append(f"ament_target_dependencies({node} {needs})")
        if library:
            lines.append(f"target_link_libraries({node} {library})")
        lines.append(f"install(TARGETS {node} DESTINATION lib/${{PROJECT_NAME}})")
    if ament:
        lines += ["", "if(BUILD_TESTING)", "  find_package(ament_lint_auto REQUIRED)"]
        lines += ["  ament_lint_auto_find_test_dependencies()", "endif()"]
        if library:
            lines += ["", "ament_export_include_directories(include)", f"ament_export_libraries({library})"]
            lines.append(f"ament_export_targets(export_{name})")
        lines += ["", "ament_package()"]
    else:
        if library:
            lines += ["", f"install(EXPORT export_{name} DESTINATION share/${{PROJECT_NAME}}/cmake)"]
        config = f"${{CMAKE_CURRENT_BINARY_DIR}}/{name}Config.cmake"
        lines += ["", f"configure_file({name}Config.cmake.in {config} @ONLY)"]
        lines.append(f"install(FILES {config} DESTINATION share/${{PROJECT_NAME}}/cmake)")
    return "\n".join([*lines, ""])


_HEADER = """\
#ifndef {guard}
#define {guard}

#include "{name}/visibility_control.h"

namespace {name}
{{

class {macro}_PUBLIC {kind}
{{
public:
  {kind}();
  virtual ~{kind}();
}};

}}  // namespace {name}

#endif  // {guard}
"""
_LIBRARY = """\
#include "{name}/{library}.hpp"

namespace {name}
{{

{kind}::{kind}()
{{
}}

{kind}::~{kind}()
{{
}}

}}  // namespace {name}
"""
_VISIBILITY = """\
#ifndef {macro}__VISIBILITY_CONTROL_H_
#define {macro}__VISIBILITY_CONTROL_H_

#if defined(_WIN32) && defined({macro}_BUILDING_LIBRARY)
#define {macro}_PUBLIC __declspec(dllexport)
#elif defined(_WIN32)
#define {macro}_PUBLIC __declspec(dllimport)
#else
#define {macro}_PUBLIC __attribute__((visibility("default")))
#endif

#endif  // {macro}__VISIBILITY_CONTROL_H_
"""
_CONFIG = """\
include("${{CMAKE_CURRENT_LIST_DIR}}/export_{name}.cmake")
set({name}_LIBRARIES {library})
"""
_EMPTY_CONFIG = "# nothing to export yet\n"
