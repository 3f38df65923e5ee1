"""A time that is measured since the last call, because its start is set anew, or that is added up in every call."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Place, Words, assigned, functions, nodes_of, unparse, walk
from gz_course.grader.feedback.slips import slip, slip_of

TIME = re.compile(r"\bnow\b|clock|stamp|nanosec|time", re.IGNORECASE)  # in what makes a time
LONG = 1.0  # [s] or more is no time between two calls


@slip_of(ast.FunctionDef)
def set_anew(function: ast.FunctionDef) -> Words:
    """Find `now - self.start` that is compared with seconds, where each call also sets `self.start = now`."""
    always = {
        unparse(statement.targets[0]): statement
        for statement in function.body
        if isinstance(statement, ast.Assign) and isinstance(statement.targets[0], ast.Attribute)
    }
    since: dict[str, str] = {}  # name of a difference -> its start
    for node in nodes_of(function, ast.Assign):
        if start := _start(node.value, always):
            since[unparse(node.targets[0])] = start
    for asked in nodes_of(function, ast.Compare):
        if not _is_long(asked.comparators[0]):
            continue
        start = _start(asked.left, always) or since.get(unparse(asked.left), "")
        if start:
            line = always[start].lineno
            yield (
                line,
                f"{start} is set again in every call of {function.name}, so line {asked.lineno} compares the time "
                "since the last call: what is measured from the start is set once",
            )


def _start(value: ast.expr, always: dict[str, ast.Assign]) -> str:
    """Return the start of which a time is the difference, if each call sets it to the same end."""
    for node in nodes_of(value, ast.BinOp):
        if isinstance(node.op, ast.Sub):
            start, end = unparse(node.right), unparse(node.left)
            if start in always and unparse(always[start].value) == end:
                return start
    return ""


def _is_long(value: ast.expr) -> bool:
    """Return whether an expression is a number, or a Duration, of a second or more."""
    numbers = [each.value for each in nodes_of(value, ast.Constant) if isinstance(each.value, int | float)]
    return any(number >= LONG for number in numbers)


@slip
def added_up(tree: ast.AST) -> Iterator[Place]:
    """Find `self.driven += now - self.start` in a callback that does not set the start anew."""
    once = {
        unparse(target)
        for node in nodes_of(tree, ast.If)
        if _asks_for_none(node.test)
        for statement in node.body
        for target, value in assigned(statement)
        if TIME.search(unparse(value))
    }
    for function in functions(tree):
        inside = {
            id(each)
            for node in nodes_of(function, ast.If)
            if _asks_for_none(node.test)
            for statement in node.body
            for each in walk(statement)
        }
        again = {unparse(target) for target, value in assigned(function) if id(value) not in inside}
        for node in nodes_of(function, ast.AugAssign):
            if not isinstance(node.op, ast.Add):
                continue
            for each in nodes_of(node.value, ast.BinOp):
                if isinstance(each.op, ast.Sub):
                    start = unparse(each.right)
                    if start in once - again and start.startswith("self."):
                        yield (
                            node.lineno,
                            f"{unparse(node)[:70]} adds the whole time since {start} in every call, although "
                            f"{start} stays the same: that time is a difference, with = and not +=",
                        )


def _asks_for_none(test: ast.expr) -> bool:
    return isinstance(test, ast.UnaryOp) or unparse(test).endswith("is None")
