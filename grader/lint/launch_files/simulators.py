"""The actions of a launch file that start a simulator, and the condition of each: two may start where one is meant."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import Any

from gz_course.grader.lint.launch_files.actions import endless
from gz_course.grader.lint.launch_files.reading import LaunchFile, argument
from gz_course.grader.lint.syntax import last_name

STARTS = ("ExecuteProcess", "ExecuteLocal", "Node", "IncludeLaunchDescription")
SIMULATORS = ("gz sim", "gz_sim.launch.py")


def simulators(file: LaunchFile) -> Iterator[dict[str, Any]]:
    """Yield `line` and `condition` (its code, or empty) of each action that starts a simulator.

    Nothing is yielded if Python decides which of them are made, or if a function makes them.
    """
    inside: dict[int, str] = {}
    for group in file.calls("GroupAction", "TimerAction", "RegisterEventHandler"):
        condition = argument(group, "condition")
        inside |= {id(each): ast.unparse(condition) if condition else "" for each in ast.walk(group) if condition}
    decided = {
        id(each)
        for node in file.nodes
        if isinstance(node, ast.If | ast.IfExp | ast.For | ast.ListComp | ast.Lambda)
        or (isinstance(node, ast.FunctionDef) and node.name != "generate_launch_description")
        for each in ast.walk(node)
    }
    for call in file.calls(*STARTS):
        if last_name(call.func) in STARTS and endless(call) in SIMULATORS and id(call) not in decided:
            condition = argument(call, "condition")
            yield {"line": call.lineno, "condition": ast.unparse(condition) if condition else inside.get(id(call), "")}
