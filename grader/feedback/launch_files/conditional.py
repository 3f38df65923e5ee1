"""Conditions on the argument that pauses the world: at the wrong simulator, or at a program that is always needed.

Whether a world is paused decides whether time passes; the programs are there in both cases. Who starts the same program
under either condition starts it always.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import last_name, unparse, walk
from gz_course.grader.feedback.launch_files import launch_slip
from gz_course.grader.feedback.launch_files.actions import endless
from gz_course.grader.feedback.launch_files.reading import LaunchFile, Place, argument, text

BEFORE = ("flags", "namespaces", "of_python", "ros_arguments")
CONDITIONS = {"IfCondition": "true", "UnlessCondition": "false"}
OF_A_SIMULATOR = ("gz", "gz_sim.launch.py", "gz sim")


@launch_slip
def swapped_conditions(file: LaunchFile) -> Iterator[Place]:
    """Find a `gz sim` with -r under the condition that the world is to be paused, or one without it under the other."""
    for call, kind, name, asked in _under_conditions(file, "ExecuteProcess", "IncludeLaunchDescription"):
        words = [text(each) for part in (*call.args, *call.keywords) for each in walk(part)]
        if not endless(call) or any("$" in word for word in words):
            continue
        runs = any("-r" in word.split() for word in words)
        if runs == (kind == "IfCondition"):
            other = "UnlessCondition" if runs else "IfCondition"
            yield (
                call.lineno,
                f"this gz sim has {'-r, so its world runs' if runs else 'no -r, so its world is paused'}, and "
                f"{kind}({asked}) starts it if {name} is {CONDITIONS[kind]}: {other} is the right one here",
            )


@launch_slip
def only_if_paused(file: LaunchFile) -> Iterator[Place]:
    """Find a node, or a group with one, under a condition on the argument that pauses the world."""
    found = list(_under_conditions(file, "Node", "GroupAction"))
    for call, kind, name, _ in found:
        words = [text(each) for each in walk(call)]
        if any(word in OF_A_SIMULATOR or word.startswith("gz sim") for word in words) or not _programs(call):
            continue
        if any(other != kind and _programs(call) & _programs(each) for each, other, _, _ in found):
            continue
        yield (
            call.lineno,
            f"{kind}({name}) starts this only if {name} is {CONDITIONS[kind]}, but whether the world is paused decides "
            "about the simulator alone",
        )


def _under_conditions(file: LaunchFile, *names: str) -> Iterator[tuple[ast.Call, str, str, str]]:
    """Yield the actions under a condition on the argument that pauses the world.

    Each with the kind of the condition, the argument's name, and what the condition asks as it is written.
    """
    for call in file.calls(*names):
        condition = file.value(argument(call, "condition"))
        if not isinstance(condition, ast.Call) or not condition.args or last_name(condition.func) not in CONDITIONS:
            continue
        name = file.configuration(condition.args[0])
        if name.startswith("pause"):
            yield call, last_name(condition.func), name, unparse(condition.args[0])


def _programs(call: ast.Call) -> set[str]:
    """Return what the nodes in a call are: their executable with its arguments, as they are written."""
    nodes = [each for each in walk(call) if isinstance(each, ast.Call) and last_name(each.func) == "Node"]
    given = ([argument(each, name) for name in ("package", "executable", "arguments")] for each in nodes)
    return {" ".join(unparse(each) for each in words if each is not None) for words in given}
