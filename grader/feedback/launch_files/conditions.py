"""The actions of a launch file that start a simulator or a bridge, and the condition that keeps each of them back."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import Any

from gz_course.grader.feedback.facts.syntax import unparse, walk
from gz_course.grader.feedback.launch_files import launch_fact
from gz_course.grader.feedback.launch_files.actions import MAIN, endless
from gz_course.grader.feedback.launch_files.reading import LaunchFile, argument

STARTS = ("ExecuteProcess", "ExecuteLocal", "Node", "IncludeLaunchDescription")
GROUPS = ("GroupAction", "TimerAction", "RegisterEventHandler")
SIMULATORS = ("gz sim", "gz_sim.launch.py")
DECIDES = ast.If | ast.IfExp | ast.For | ast.ListComp | ast.Lambda


@launch_fact("simulators_made")
def simulators(file: LaunchFile) -> Iterator[dict[str, Any]]:
    """Yield `line` and `condition` (its code, or empty) of each action that starts a simulator.

    Nothing is yielded for those that a function makes, or about which Python decides.
    """
    yield from _actions(file, SIMULATORS)


@launch_fact("bridges_made")
def bridges(file: LaunchFile) -> Iterator[dict[str, Any]]:
    """Yield the same of each action that starts a bridge."""
    yield from _actions(file, ("parameter_bridge",))


def _actions(file: LaunchFile, programs: tuple[str, ...]) -> Iterator[dict[str, Any]]:
    grouped: dict[int, str] = {}
    for group in file.calls(*GROUPS):
        if condition := argument(group, "condition"):
            grouped |= {id(each): unparse(condition) for part in file.parts(group) for each in walk(part)}
    decided = {
        id(each)
        for node in file.nodes
        if isinstance(node, DECIDES) or (isinstance(node, ast.FunctionDef) and node.name != MAIN)
        for each in walk(node)
    }
    for call in file.calls(*STARTS):
        if endless(call) in programs and id(call) not in decided:
            condition = argument(call, "condition")
            yield {"line": call.lineno, "condition": unparse(condition) if condition else grouped.get(id(call), "")}
