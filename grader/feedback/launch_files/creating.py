"""Options of `create` of ros_gz_sim that get the value of another one, or a value that fits one world only.

Source: https://github.com/gazebosim/ros_gz, ros_gz_sim/src/create.cpp
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from itertools import pairwise

from gz_course.grader.feedback.launch_files import launch_slip
from gz_course.grader.feedback.launch_files.reading import LaunchFile, Place, argument, text

HEADINGS = frozenset({"yaw", "heading", "theta", "rotation", "angle", "direction"})
AXES = {
    "-x": "the place along x",
    "-y": "the place along y",
    "-z": "the height",
    "-R": "roll, the turn about the axis that points ahead",
    "-P": "pitch, the turn about the axis that points to the left",
    "-Y": "yaw, the turn about the vertical axis, which is the heading",
}


def _flat(words: list[ast.expr]) -> list[ast.expr]:
    """Return the words of a command, those of `*("-x", x)` among them."""
    inside = (each.value if isinstance(each, ast.Starred) else each for each in words)
    found = (_flat(each.elts) if isinstance(each, ast.Tuple | ast.List) else [each] for each in inside)
    return [each for part in found for each in part]


def _options(file: LaunchFile) -> Iterator[tuple[ast.expr, ast.expr]]:
    """Yield each word of the commands of create, with the next one."""
    for call in file.calls("Node"):
        given = file.value(argument(call, "arguments"))
        if text(argument(call, "executable", 0)) == "create" and isinstance(given, ast.List | ast.Tuple):
            yield from pairwise(_flat(given.elts))


@launch_slip
def axes_of_create(file: LaunchFile) -> Iterator[Place]:
    """Find an option of create of ros_gz_sim that is given the launch argument of another one."""
    for option, value in _options(file):
        flag, name = text(option), file.configuration(value)
        right = f"-{name}" if name in ("x", "y", "z") else "-Y" if name in HEADINGS else ""
        if flag in AXES and right and flag != right:
            yield (
                option.lineno,
                f"create takes {flag} for {AXES[flag]}, and here it gets the launch argument {name}: {right} is "
                f"{AXES[right]}",
            )


@launch_slip
def created_twice(file: LaunchFile) -> Iterator[Place]:
    """Find two actions with create that give a robot the same name, and that no condition keeps apart."""
    seen: dict[str, int] = {}
    for call in file.calls("Node"):
        given = file.value(argument(call, "arguments"))
        if text(argument(call, "executable", 0)) != "create" or argument(call, "condition"):
            continue
        words = _flat(given.elts) if isinstance(given, ast.List | ast.Tuple) else []
        name = next((text(value) for option, value in pairwise(words) if text(option) == "-name"), "")
        if name and name in seen:
            yield call.lineno, f"create makes a second {name} here, beside that of line {seen[name]}: one is enough"
        seen.setdefault(name, call.lineno)


@launch_slip
def world_of_create(file: LaunchFile) -> Iterator[Place]:
    """Find `-world NAME` with a name that is written down, in a file whose argument says which world runs."""
    declared = {text(argument(call, "name", 0)) for call in file.calls("DeclareLaunchArgument")}
    for option, value in _options(file) if "world" in declared else ():
        if text(option) in ("-world", "--world") and text(value):
            yield (
                value.lineno,
                f"create waits for the world {text(value)} alone, whatever the argument world says: without "
                f"{text(option)} it takes the world that runs",
            )
