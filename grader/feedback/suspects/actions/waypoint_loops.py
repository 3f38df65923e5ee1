"""Suspects in the loop over the waypoints of a goal: it is left in its first iteration, or leaves one of them out."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import (
    Words,
    assigned,
    called,
    functions,
    last_name,
    nodes_of,
    unparse,
    walk,
)
from gz_course.grader.feedback.suspects import suspicion, suspicion_of
from gz_course.grader.feedback.suspects.about import About, Suspect

POINTS = ("waypoints", "points", "goals", "targets", "route", "path", "todo")


def _drives(tree: ast.AST) -> Iterator[ast.FunctionDef]:
    """Yield the functions that end goals."""
    for function in functions(tree):
        if called(function) & {"succeed"}:
            yield function


@suspicion_of(About.LEFT_EARLY)
def flags_never_set_back(tree: ast.AST) -> Words:
    """Find `while not self.arrived` in a loop over waypoints, where the flag becomes True and never False again."""
    values: dict[str, set[object]] = {}
    for function in functions(tree):
        for target, value in assigned(function) if function.name != "__init__" else ():
            constant = value.value if isinstance(value, ast.Constant) else None
            values.setdefault(unparse(target), set()).add(constant)
    for function in _drives(tree):
        for loop in nodes_of(function, ast.For):
            for inner in (each for part in loop.body for each in nodes_of(part, ast.While)):
                for node in walk(inner.test):
                    match node:
                        case ast.UnaryOp(op=ast.Not(), operand=ast.Attribute(value=ast.Name(id="self")) as flag):
                            if values.get(name := unparse(flag)) == {True}:
                                yield (
                                    inner,
                                    f"{name} stays True from the first waypoint on, so `{unparse(node)}` is False "
                                    f"at once for the next: set {name} to False before this loop",
                                )


def _number(node: ast.AST | None) -> int:
    """Return a whole number, also -1, which is an operator and 1; 0 for anything else."""
    sign = -1 if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub) else 1
    node = node.operand if isinstance(node, ast.UnaryOp) else node
    return sign * node.value if isinstance(node, ast.Constant) and isinstance(node.value, int) else 0


def _is_points(node: ast.AST) -> bool:
    return last_name(node).strip("_") in POINTS


def _one_less(node: ast.AST | None) -> bool:
    """Return whether a node is `len(waypoints) - 1`."""
    match node:
        case ast.BinOp(
            left=ast.Call(func=ast.Name(id="len"), args=[points]), op=ast.Sub(), right=ast.Constant(value=1)
        ):
            return _is_points(points)
    return False


@suspicion_of(About.LEFT_EARLY)
def left_in_the_first_round(tree: ast.AST) -> Words:
    """Find a return, or a break, that every round of a loop over waypoints comes to."""
    for function in _drives(tree):
        for loop in nodes_of(function, ast.For):
            for statement in loop.body:
                if isinstance(statement, ast.Return | ast.Break):
                    what = "return" if isinstance(statement, ast.Return) else "break"
                    yield (
                        statement,
                        f"this {what} ends the loop of line {loop.lineno} in its first iteration: it belongs after the "
                        "loop",
                    )


def _left_out(given: ast.AST) -> str:
    """Return which waypoint a loop over something leaves out; empty if it is none."""
    for node in walk(given):
        match node:
            case ast.Subscript(value=points, slice=ast.Slice(lower=lower, upper=upper)) if _is_points(points):
                if _number(lower) > 0:
                    return "first"
                if _number(upper) < 0 or _one_less(upper):
                    return "last"
            case ast.Call(func=ast.Name(id="range"), args=[one]) if _one_less(one):
                return "last"
            case ast.Call(func=ast.Name(id="range"), args=[first, last, *_]):
                if _one_less(last):
                    return "last"
                if _number(first) == 1 and unparse(last).startswith("len("):
                    return "first"
    return ""


def _begins_at_one(function: ast.FunctionDef) -> Iterator[Suspect]:
    """Find an index that begins at 1 and counts up to the number of waypoints."""
    loops = [each for each in nodes_of(function, ast.While) if isinstance(each.test, ast.Compare)]
    counts = {
        unparse(each.test.left)  # type: ignore[attr-defined]
        for each in loops
        if isinstance(each.test.ops[0], ast.Lt)  # type: ignore[attr-defined]
        and unparse(each.test.comparators[0]).startswith("len(")  # type: ignore[attr-defined]
    }
    for statement in function.body:
        for target, value in assigned(statement) if isinstance(statement, ast.Assign) else ():
            name = unparse(target)
            indexes = any(isinstance(each, ast.Subscript) and unparse(each.slice) == name for each in walk(function))
            if name in counts and _number(value) == 1 and indexes:
                yield (
                    statement.lineno,
                    About.LEFT_OUT,
                    f"`{unparse(statement)}` leaves out the first waypoint, whose index is 0",
                )


@suspicion
def waypoints_left_out(tree: ast.AST) -> Iterator[Suspect]:
    """Find a loop over `waypoints[1:]`, `range(len(waypoints) - 1)` and the like."""
    for function in _drives(tree):
        for node in walk(function):
            which, part = "", node
            match node:
                case ast.For(iter=part) | ast.comprehension(iter=part):
                    which = _left_out(part)
                case ast.While(test=ast.Compare(ops=[ast.Lt() | ast.NotEq()], comparators=[last]) as part):
                    which = "last" if _one_less(last) else ""
            if which:
                line = getattr(part, "lineno", function.lineno)
                yield line, About.LEFT_OUT, f"`{unparse(part)[:60]}` leaves out the {which} waypoint"
        yield from _begins_at_one(function)
