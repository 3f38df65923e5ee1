"""Suspects in the loop over the waypoints of a goal: one is left out, or counts before the robot is there."""

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
from gz_course.grader.feedback.suspects import suspicion, suspicion_of
from gz_course.grader.feedback.suspects.about import About, Suspect

FIELD, CANCELLED = "visited", "is_cancel_requested"
Loop = ast.While | ast.For
POINTS = ("waypoints", "points", "goals", "targets", "route", "path", "todo")


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
