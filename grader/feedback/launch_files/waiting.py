"""Programs that the Python of a launch file starts and waits for, while the launch stands still.

Source: ros2/launch, launch/launch/launch_service.py (one loop visits all actions, and calls the functions of those)
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import assigned, last_name, unparse, walk
from gz_course.grader.feedback.launch_files import launch_slip
from gz_course.grader.feedback.launch_files.reading import LaunchFile, Place, text

WAIT = frozenset({"run", "call", "check_call", "check_output", "getoutput", "getstatusoutput", "system"})
MODULES = frozenset({"subprocess", "os"})
CREATORS = ("create", "remove")  # programs that wait for a world that runs
ASKING = ("service", "topic")  # commands of gz that ask a running world
ENDLESS = ("parameter_bridge", "robot_state_publisher")


@launch_slip
def waits(file: LaunchFile) -> Iterator[Place]:
    """Find a program that Python waits for, and that ends only after the launch has gone on, or with it.

    What a timer or an event starts may find a simulator that runs already.
    """
    later = any(file.calls("TimerAction", "RegisterEventHandler"))
    imported = {
        alias.asname or alias.name
        for node in file.nodes
        if isinstance(node, ast.ImportFrom) and node.module in MODULES
        for alias in node.names
    }
    for call in file.calls(*WAIT):
        if not call.args or not _is_of_subprocess(call.func, imported):
            continue
        words = _words(file, call.args[0])
        how = unparse(call.func)
        if name := next((word for word in CREATORS if "ros_gz_sim" in words and word in words), ""):
            if later:
                continue
            yield (
                call.lineno,
                f"{how} waits here until {name} ends, and the whole launch stands still meanwhile: the simulator that "
                f"{name} waits for is not started. Return an action that starts it instead: Node(package='ros_gz_sim', "
                f"executable='{name}', arguments=[...])",
            )
        elif name := next((word for word in ASKING if words[:1] == ["gz"] and word in words[1:2]), ""):
            if later:
                continue
            yield (
                call.lineno,
                f"{how} calls gz {name} while the launch stands still, so the simulator that it asks is not started "
                "yet: an ExecuteProcess starts it as an action of the launch",
            )
        elif name := _endless(words):
            yield (
                call.lineno,
                f"{how} waits here until {name} ends, which never happens, and the whole launch stands still "
                "meanwhile: an action of the launch starts it and goes on (ExecuteProcess, Node)",
            )


def _is_of_subprocess(function: ast.expr, imported: set[str]) -> bool:
    if isinstance(function, ast.Attribute):
        return last_name(function.value) in MODULES
    return isinstance(function, ast.Name) and function.id in imported


def _endless(words: list[str]) -> str:
    if words[:2] == ["gz", "sim"]:
        return "gz sim"
    return next((name for name in ENDLESS if name in words), "")


def _words(file: LaunchFile, command: ast.expr) -> list[str]:
    """Return the words of a command that are written down, also of a list that a name stands for."""
    parts = [command]
    if isinstance(command, ast.Name):
        parts = [value for target, value in assigned(file.tree) if last_name(target) == command.id]
    texts = [each for part in parts for each in walk(part) if text(each)]
    texts.sort(key=lambda each: (getattr(each, "lineno", 0), getattr(each, "col_offset", 0)))
    return [word for each in texts for word in text(each).split()]
