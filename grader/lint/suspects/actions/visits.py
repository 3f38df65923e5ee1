"""Suspects in the number of visited waypoints: one counts before the robot is there, or what is said is no count."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.lint.syntax import Suspect, assigned, called, functions, last_name, walk

FIELD = "visited"
Loop = ast.While | ast.For


def _counts(tree: ast.AST) -> set[str]:
    """Return the names of the field `visited`, and of all that it is set to."""
    found = {ast.unparse(t) for t, _ in assigned(tree) if isinstance(t, ast.Attribute) and t.attr == FIELD}
    for value in _given(tree):
        if isinstance(value, ast.Name | ast.Attribute):
            found.add(ast.unparse(value))
    return found


def _given(tree: ast.AST) -> Iterator[ast.expr]:
    """Yield what is given to the field `visited`."""
    yield from (node.value for node in walk(tree) if isinstance(node, ast.keyword) and node.arg == FIELD)
    for target, value in assigned(tree):
        if isinstance(target, ast.Attribute) and target.attr == FIELD:
            yield value


def _drivers(tree: ast.AST) -> set[str]:
    """Return the functions with a loop that sleeps: what they do takes time."""
    return {f.name for f in functions(tree) for n in walk(f) if isinstance(n, ast.While) and "sleep" in called(n)}


def _takes_time(statement: ast.stmt, drivers: set[str]) -> bool:
    loops = any(isinstance(each, ast.While) and called(each) & {"sleep", *drivers} for each in walk(statement))
    return loops or bool(called(statement) & drivers)


def counted_on_departure(tree: ast.AST) -> Iterator[Suspect]:
    """Find a count that goes up above what drives to the waypoint, in the loop over the waypoints."""
    names, drivers = _counts(tree), _drivers(tree)
    for loop in (each for each in walk(tree) if isinstance(each, Loop)):
        for number, statement in enumerate(loop.body):
            if not isinstance(statement, ast.Assign | ast.AugAssign):
                continue
            later = loop.body[number + 1 :]
            if any(_takes_time(each, drivers) for each in loop.body[:number]):
                break
            for target, value in assigned(statement):
                if ast.unparse(target) not in names or (isinstance(value, ast.Constant) and value.value == 0):
                    continue
                grows = isinstance(statement, ast.AugAssign) or isinstance(value, ast.BinOp | ast.Name)
                driven = next((each for each in later if _takes_time(each, drivers)), None)
                if grows and driven is not None:
                    yield (
                        statement.lineno,
                        "counted",
                        f"`{ast.unparse(statement)}` counts the waypoint before line {driven.lineno} drives to it: it "
                        "belongs below that, where the robot has arrived",
                    )


def counted_when_cancelled(tree: ast.AST) -> Iterator[Suspect]:
    """Find a number of visited waypoints that is made where a goal is cancelled, and is no count."""
    for test in (each for each in walk(tree) if isinstance(each, ast.If)):
        if not any("canceled" in called(each) for each in test.body):
            continue
        for value in (each for part in test.body for each in _given(part)):
            text = ast.unparse(value)
            if isinstance(value, ast.Call) and last_name(value.func) == "len":
                yield value.lineno, "counted", f"`{text}` is the number of all waypoints of the goal, visited or not"
            elif isinstance(value, ast.BinOp) and isinstance(value.op, ast.Add) and _is_one(value.right):
                yield (
                    value.lineno,
                    "counted",
                    f"`{text}` counts the waypoint to which the robot is still driving; `{ast.unparse(value.left)}` "
                    "have been visited",
                )


def _is_one(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and node.value == 1


LOOKS = (counted_on_departure, counted_when_cancelled)
