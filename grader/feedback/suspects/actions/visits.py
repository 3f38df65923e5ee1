"""Suspects in the number of visited waypoints: one counts before the robot is there, or what is said is no count."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from gz_course.grader.feedback.facts.syntax import (
    Words,
    assigned,
    called,
    functions,
    last_name,
    left_early,
    nodes_of,
    unparse,
    walk,
)
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

FIELD, CANCELLED = "visited", "is_cancel_requested"
Loop = ast.While | ast.For


def _counts(tree: ast.AST) -> set[str]:
    """Return the names of the field `visited`, and of all that it is set to."""
    found = {unparse(t) for t, _ in assigned(tree) if isinstance(t, ast.Attribute) and t.attr == FIELD}
    for value in _given(tree):
        if isinstance(value, ast.Name | ast.Attribute):
            found.add(unparse(value))
    return found


def _given(tree: ast.AST) -> Iterator[ast.expr]:
    """Yield what is given to the field `visited`."""
    yield from (node.value for node in nodes_of(tree, ast.keyword) if node.arg == FIELD)
    for target, value in assigned(tree):
        if isinstance(target, ast.Attribute) and target.attr == FIELD:
            yield value


def _drivers(tree: ast.AST) -> set[str]:
    """Return the functions with a loop that sleeps: what they do takes time."""
    return {f.name for f in functions(tree) for n in nodes_of(f, ast.While) if "sleep" in called(n)}


def _takes_time(statement: ast.stmt, drivers: set[str]) -> bool:
    loops = any(isinstance(each, ast.While) and called(each) & {"sleep", *drivers} for each in walk(statement))
    return loops or bool(called(statement) & drivers)


@suspicion_of(About.COUNTED)
def counted_on_departure(tree: ast.AST) -> Words:
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
                if unparse(target) not in names or (isinstance(value, ast.Constant) and value.value == 0):
                    continue
                grows = isinstance(statement, ast.AugAssign) or isinstance(value, ast.BinOp | ast.Name)
                driven = next((each for each in later if _takes_time(each, drivers)), None)
                if grows and driven is not None:
                    yield (
                        statement,
                        f"`{unparse(statement)}` counts the waypoint before line {driven.lineno} drives to it: it "
                        "belongs below that, where the robot has arrived",
                    )


@suspicion_of(About.COUNTED, ast.If)
def counted_when_cancelled(test: ast.If) -> Words:
    """Find a number of visited waypoints that is made where a goal is cancelled, and is no count."""
    if not any("canceled" in called(each) for each in test.body):
        return
    for value in (each for part in test.body for each in _given(part)):
        text = unparse(value)
        if isinstance(value, ast.Call) and last_name(value.func) == "len":
            yield value, f"`{text}` is the number of all waypoints of the goal, visited or not"
        elif isinstance(value, ast.BinOp) and isinstance(value.op, ast.Add) and _is_one(value.right):
            yield (
                value,
                f"`{text}` counts the waypoint to which the robot is still driving; `{unparse(value.left)}` "
                "have been visited",
            )


def _is_one(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and node.value == 1


@suspicion_of(About.COUNTED)
def counted_after_a_break(tree: ast.AST) -> Words:
    """Find an inner loop that a cancellation ends, where the loop over the waypoints goes on and counts."""
    names = _counts(tree)
    own = {function.name: function for function in functions(tree)}
    for loop in (each for each in walk(tree) if isinstance(each, Loop)):
        ended: _End | None = None
        for statement in loop.body:
            if (found := _ended_by_a_cancellation(statement, own)) is not None or ended is None:
                ended = found
                continue
            asks = {CANCELLED, *ended.flags} & set(re.findall(r"\w+", unparse(statement)))
            if asks or (left_early(statement) and not isinstance(statement, Loop)):
                break
            counted = next((t for t, _ in assigned(statement) if unparse(t) in names), None)
            if counted is not None and isinstance(statement, ast.Assign | ast.AugAssign):
                leaves = any(left_early(each) for each in loop.body if not isinstance(each, Loop))
                then = "" if leaves else f", and the loop of line {loop.lineno} goes on to the next one"
                yield (
                    ended.line,
                    f"{ended.what} when the goal is cancelled; then line {statement.lineno}, `{unparse(statement)}`, "
                    f"counts the waypoint all the same{then}: ask for is_cancel_requested before that line, too",
                )
                break


@dataclass(frozen=True)
class _End:
    """What ends the drive to one waypoint when a goal is cancelled, and the flags that it sets meanwhile."""

    line: int
    what: str
    flags: frozenset[str] = frozenset()


def _ended_by_a_cancellation(statement: ast.stmt, own: Mapping[str, ast.FunctionDef]) -> _End | None:
    """Return what ends a loop, or a function of the file whose result is dropped, when a goal is cancelled."""
    if isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Call):
        function = own.get(last_name(statement.value.func))
        loops = [each for each in nodes_of(function, ast.While)] if function is not None else []
        if function is not None and any(CANCELLED in unparse(each) for each in loops):
            sets = (last_name(target) for target, _ in assigned(function) if isinstance(target, ast.Attribute))
            return _End(statement.lineno, f"{function.name}() returns", frozenset(sets))
    if not isinstance(statement, ast.While | ast.For) or statement.orelse:
        return None
    if isinstance(statement, ast.While) and CANCELLED in unparse(statement.test):
        return _End(statement.lineno, f"`while {unparse(statement.test)[:80]}` ends")
    for test in (each for part in statement.body for each in nodes_of(part, ast.If)):
        if CANCELLED in unparse(test.test) and isinstance(test.body[-1], ast.Break):
            flags = frozenset(last_name(target) for part in test.body for target, _ in assigned(part))
            return _End(test.body[-1].lineno, "this break leaves only the inner loop", flags)
    return None
