"""Actions of a launch file that never happen, or happen when it is too late.

Source: ros2/launch, launch/launch/event_handlers/on_process_exit.py, launch/launch/actions/opaque_function.py
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping

from gz_course.grader.feedback.facts.syntax import called, last_name, nodes_of, parsed, walk
from gz_course.grader.feedback.launch_files import launch_slip
from gz_course.grader.feedback.launch_files.reading import ACTIONS, PROCESSES, LaunchFile, Place, argument, text

BEFORE = ("flags", "namespaces", "of_python", "ros_arguments")


LONG = 5.0  # [s] of a TimerAction; what starts later than that misses most of a graded run
MAIN = "generate_launch_description"
ENDS = {"shutdown", "try_shutdown", "exit", "_exit", "SystemExit", "ExternalShutdownException"}
ENDLESS = ("gz_sim.launch.py", "parameter_bridge", "robot_state_publisher", "static_transform_publisher")


@launch_slip
def declared_too_late(file: LaunchFile) -> Iterator[Place]:
    """Find an OpaqueFunction that asks for an argument which only a later item of the list declares."""
    own = {node.name: node for node in file.tree.body if isinstance(node, ast.FunctionDef)}
    for call in file.calls("LaunchDescription"):
        given = file.value(argument(call, "initial_entities", 0))
        actions = [file.value(each) for each in given.elts] if isinstance(given, ast.List) else []
        for place, action in enumerate(actions):
            if not isinstance(action, ast.Call) or last_name(action.func) != "OpaqueFunction":
                continue
            function = own.get(last_name(argument(action, "function", 0) or action.func))
            asked = {text(each) for each in walk(function)} if function is not None else set()
            for other in actions[place + 1 :]:
                if isinstance(other, ast.Call) and last_name(other.func) == "DeclareLaunchArgument":
                    name = text(argument(other, "name", 0))
                    if name and name in asked:
                        yield (
                            other.lineno,
                            f"{name} is declared here, behind the OpaqueFunction of line {action.lineno}, which asks "
                            "for its value before that: DeclareLaunchArgument belongs above it in the list",
                        )


def _listed(value: ast.expr) -> list[ast.expr]:
    return value.elts if isinstance(value, ast.List | ast.Tuple) else [value]


def _is_action(node: ast.AST) -> bool:
    return isinstance(node, ast.Call) and last_name(node.func) in ACTIONS


@launch_slip
def called_functions(file: LaunchFile) -> Iterator[Place]:
    """Find an OpaqueFunction that gets the result of a function in place of the function."""
    for call in file.calls("OpaqueFunction"):
        given = argument(call, "function")
        if isinstance(given, ast.Call) and last_name(given.func) not in ("partial", ""):
            name = last_name(given.func)
            yield (
                given.lineno,
                f"{name}(...) calls the function at once, while the description is made; OpaqueFunction takes the "
                f"function itself, function={name}, and calls it with the context when the launch runs",
            )


@launch_slip
def functions_without_effect(file: LaunchFile) -> Iterator[Place]:
    """Find a function that makes actions and is never called, or is that of an OpaqueFunction and returns nothing."""
    opaque = {last_name(given) for call in file.calls("OpaqueFunction") if (given := argument(call, "function"))}
    for node in file.tree.body:
        if not isinstance(node, ast.FunctionDef) or node.name == MAIN:
            continue
        if not any(_is_action(each) for each in walk(node)):
            continue
        returned = [each for each in nodes_of(node, ast.Return) if each.value is not None]
        if node.name not in file.used:
            yield node.lineno, f"the function {node.name} makes actions, but nothing calls it"
        elif node.name in opaque and not returned:
            yield (
                node.lineno,
                f"{node.name} returns nothing: the actions that the function of an OpaqueFunction makes happen only if "
                "it returns them in a list",
            )


@launch_slip
def events_that_never_come(file: LaunchFile) -> Iterator[Place]:
    """Find what waits for the end of a program that runs as long as the launch does; `nodes` are the student's own."""
    for call in file.calls("OnProcessExit"):
        then = argument(call, "on_exit")
        target = argument(call, "target_action", 0)
        parts = file.parts(target) if target is not None else [file.tree]
        what = endless(*parts) or (_own_node(parts, file.beside) if target is not None else "")
        ends = any(text(each) in ("create", "remove") for each in file.nodes)
        if what and then is not None and _starts(then, file) and not (target is None and ends):
            yield (
                call.lineno,
                f"OnProcessExit starts this only when {what} has ended, and it runs as long as the launch does: "
                "OnProcessStart is the event for what is to start after it",
            )


@launch_slip
def never_added(file: LaunchFile) -> Iterator[Place]:
    """Find an action that is made but not part of the launch description."""
    for node in file.nodes:
        if isinstance(node, ast.Assign):
            names = [target.id for target in node.targets if isinstance(target, ast.Name)]
            made = [each for each in _listed(node.value) if _is_action(each)]
            if names and made and not file.used.intersection(names):
                yield (
                    node.lineno,
                    f"{names[0]} is made here, but it is not in the LaunchDescription: an action happens only if it is "
                    "in the list that LaunchDescription gets, or is added by add_action",
                )
        elif isinstance(node, ast.Expr) and (dropped := [e for e in _listed(node.value) if _is_action(e)]):
            name = last_name(dropped[0].func) if isinstance(dropped[0], ast.Call) else ""
            yield (
                node.lineno,
                f"this {name} is made and then dropped: an action happens only if it is in the list that "
                "LaunchDescription gets, or is returned by an OpaqueFunction",
            )


@launch_slip
def too_late(file: LaunchFile) -> Iterator[Place]:
    """Find what starts only when the launch ends."""
    for call in file.calls("OnShutdown"):
        then = argument(call, "on_shutdown", 0)
        if then is not None and _starts(then, file):
            yield (
                call.lineno,
                "OnShutdown happens when the launch ends, so this is started too late: OnProcessStart is the event for "
                "what is to start after another program",
            )


def endless(*parts: ast.AST) -> str:
    """Return the name of the program that an action starts, if it is a simulator or a bridge; else nothing."""
    said = [text(each) for part in parts for each in walk(part)]
    if {"gz", "sim"} <= set(said) or any(each.startswith("gz sim") for each in said):
        return "gz sim"
    return next((name for name in ENDLESS if name in said), "")


def _own_node(parts: Iterable[ast.AST], nodes: Mapping[str, bytes]) -> str:
    """Return the name of the student's program that an action starts, if it spins and does not end by itself."""
    names = {text(each).rpartition("/")[2] for part in parts for each in walk(part)} & nodes.keys()
    for name in sorted(names):
        tree = parsed(nodes[name])
        own = [each for each in nodes_of(tree, ast.ClassDef)]
        inside = {last_name(each) for part in own for each in walk(part)}
        if "spin" in called(tree) and not inside & ENDS:
            return name
    return ""


def _starts(then: ast.expr, file: LaunchFile) -> bool:
    """Whether an expression holds actions that start something, itself or by a name or a function of the file."""
    for each in walk(then):
        value = file.value(each) if isinstance(each, ast.Name) else each
        if value is not None and any(last_name(part) in PROCESSES for part in walk(value)):
            return True
        own = [node for node in file.tree.body if isinstance(node, ast.FunctionDef) and node.name == last_name(each)]
        if any(last_name(part) in PROCESSES for node in own for part in walk(node)):
            return True
    return False


@launch_slip
def waited_for_and_never_started(file: LaunchFile) -> Iterator[Place]:
    """Find an action that an event handler waits for, and that is in no list."""
    targets = [
        given
        for call in file.calls("OnProcessStart", "OnProcessExit", "OnExecutionComplete", "OnProcessIO")
        if isinstance(given := argument(call, "target_action", 0), ast.Name)
    ]
    inside = {id(each) for each in targets}
    for name in dict.fromkeys(each.id for each in targets):
        loads = [n for n in file.nodes if isinstance(n, ast.Name) and n.id == name and isinstance(n.ctx, ast.Load)]
        made = file.assigned.get(name, [])
        if len(made) == 1 and _is_action(made[0]) and all(id(each) in inside for each in loads):
            yield (
                made[0].lineno,
                f"an event handler waits for {name}, but {name} itself is in no list of actions, so it never starts: "
                "LaunchDescription needs both, the action and the handler",
            )


@launch_slip
def long_waits(file: LaunchFile) -> Iterator[Place]:
    for call in file.calls("TimerAction"):
        period = argument(call, "period")
        value = period.value if isinstance(period, ast.Constant) else None
        if isinstance(value, int | float) and value >= LONG:
            yield (
                call.lineno,
                f"this TimerAction waits {value:g} s (its period is in seconds) before it starts anything",
            )
