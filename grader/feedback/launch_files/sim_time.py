"""The actions of a launch file that start a Python program, and which of its actions mention use_sim_time."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import Any

from gz_course.grader.feedback.facts.syntax import last_name, walk
from gz_course.grader.feedback.launch_files import launch_fact
from gz_course.grader.feedback.launch_files.reading import LaunchFile, argument, text
from gz_course.grader.feedback.launch_files.ros_arguments import command_words

SIM_TIME = "use_sim_time"


@launch_fact("programs")
def programs(file: LaunchFile) -> Iterator[dict[str, Any]]:
    """Yield `line`, `program` (the name of its file) and `sim_time`, whether the action mentions it, of each program.

    `mentioned` is the same, and false where simulated time may come in a way that is not seen, as from a file.
    `elsewhere` is what another action of a node has it for: its line and executable; 0 and empty if none has.
    """
    others = [
        (call.lineno, text(file.value(argument(call, "executable", 0))))
        for call in file.calls("Node", "LifecycleNode")
        if SIM_TIME in texts_of(file, call) and not any(word.endswith(".py") for word in texts_of(file, call))
    ]
    line, executable = others[0] if others else (0, "")
    for call in file.calls("ExecuteProcess", "ExecuteLocal", "Node"):
        words = texts_of(file, call)
        for word in words:
            name = word.rpartition("/")[2]
            if name.endswith(".py") and " " not in name:
                mentioned = any(SIM_TIME in each for each in words)
                yield {
                    "line": call.lineno,
                    "program": name,
                    "sim_time": mentioned or any(_unknown(file, call)),
                    "mentioned": mentioned,
                    "elsewhere": line,
                    "executable": executable,
                }
                break


def texts_of(file: LaunchFile, call: ast.Call) -> set[str]:
    """Return all texts of an action, those that its names stand for too."""
    parts = [*file.parts(call), *(part for part in command_words(file, call) if part is not None)]
    return {text(each) for part in parts for each in walk(part)} - {""}


def _unknown(file: LaunchFile, call: ast.Call) -> Iterator[bool]:
    """Yield whether simulated time may come to an action in a way that is not seen in it.

    It may come from a SetParameter or a parameter file, for a node, and from words that a function returns.
    """
    if last_name(call.func) == "Node":
        given = file.value(argument(call, "parameters"))
        files = given.elts if isinstance(given, ast.List | ast.Tuple) else []
        yield any(not isinstance(file.value(each), ast.Dict) for each in files)
        yield any(file.calls("SetParameter", "SetUseSimTime", "SetParametersFromFile"))
    yield None in command_words(file, call) or "--params-file" in texts_of(file, call)
