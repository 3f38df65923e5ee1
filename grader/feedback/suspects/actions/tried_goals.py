"""Suspects in a callback that answers to goals: its tests are worked out, without running it, for goals of a patrol.

A callback with anything but assignments, tests and returns has none, and neither has one whose values are unknown.
"""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

from gz_course.grader.feedback.facts.syntax import functions, unparse
from gz_course.grader.feedback.suspects import suspicion
from gz_course.grader.feedback.suspects.about import About, Suspect

LIMIT = 0.5  # [m/s] max_speed, if nobody sets it
POINTS = ("a", "b")
# What is asked, its waypoints and speed [m/s], the right answer, what a suspect is about, and its words.
GOALS = (
    (POINTS, 0.4, True, About.REFUSES_ALL, "a goal with two waypoints and 0.4 m/s"),
    ((), 0.4, False, About.ACCEPTS_EMPTY, "a goal without waypoints"),
    (POINTS, 0.8, False, About.OTHER_LIMIT, "0.8 m/s where max_speed is 0.5"),
    (POINTS, -0.2, False, About.ACCEPTS_BACKWARDS, "a speed of -0.2 m/s"),
    (POINTS, 0.0, False, About.ACCEPTS_STANDING, "a speed of 0"),
)
COMPARES: dict[type[ast.cmpop], Callable[[Any, Any], Any]] = {
    ast.Lt: operator.lt, ast.LtE: operator.le, ast.Gt: operator.gt, ast.GtE: operator.ge, ast.Eq: operator.eq,
    ast.NotEq: operator.ne, ast.Is: operator.is_, ast.IsNot: operator.is_not,
}  # fmt: skip
PLAIN: dict[str, Callable[[Any], Any]] = {"len": len, "bool": bool, "float": float, "abs": abs, "list": list}


class _Unknown(Exception):
    """A value that the file alone does not say."""


@dataclass
class _Trial:
    """One goal that is tried: its fields, the values of names, and the tests that were worked out."""

    goal: str
    points: tuple[str, ...]
    speed: float
    known: dict[str, ast.expr]  # attributes of the node, as __init__ leaves them
    names: dict[str, Any] = field(default_factory=dict)
    tests: list[tuple[ast.expr, bool]] = field(default_factory=list)

    def value(self, node: ast.expr | None) -> Any:
        """Return the value of an expression."""
        text = unparse(node) if node is not None else ""
        match node:
            case ast.Constant(value=value):
                return value
            case ast.Attribute(attr="speed", value=ast.Name(id=owner)) if owner == self.goal:
                return self.speed
            case ast.Attribute(attr="waypoints", value=ast.Name(id=owner)) if owner == self.goal:
                return self.points
            case ast.Attribute(attr="REJECT" | "ACCEPT" as answer):
                return answer
            case ast.Attribute(attr="value" | "double_value") if "_parameter(" in text:
                return LIMIT
            case ast.Name() | ast.Attribute() if text in self.names:
                return self.names[text]
            case ast.Attribute() if text in self.known:
                return self.value(self.known[text])
            case ast.UnaryOp(op=ast.Not(), operand=part):
                return not self.value(part)
            case ast.UnaryOp(op=ast.USub(), operand=part):
                return -self.value(part)
            case ast.BoolOp(op=op, values=parts):
                return self._any_or_all(parts, isinstance(op, ast.Or))
            case ast.Compare():
                return self._compared(node)
            case ast.IfExp(test=test, body=body, orelse=orelse):
                return self.value(body if self.tested(test) else orelse)
            case ast.Call(func=ast.Name(id=name), args=[part], keywords=[]) if name in PLAIN:
                return PLAIN[name](self.value(part))
        raise _Unknown

    def _any_or_all(self, parts: list[ast.expr], is_or: bool) -> Any:
        value: Any = None
        for part in parts:
            value = self.value(part)
            if bool(value) == is_or:
                break
        return value

    def _compared(self, node: ast.Compare) -> bool:
        left = self.value(node.left)
        for op, part in zip(node.ops, node.comparators, strict=True):
            right = self.value(part)
            if type(op) not in COMPARES or not COMPARES[type(op)](left, right):
                if type(op) not in COMPARES:
                    raise _Unknown
                return False
            left = right
        return True

    def tested(self, test: ast.expr) -> bool:
        """Return whether a test holds, and keep it."""
        held = bool(self.value(test))
        self.tests.append((test, held))
        return held

    def _assign(self, name: str, value: ast.expr) -> None:
        try:
            self.names[name] = self.value(value)
        except _Unknown:
            self.names.pop(name, None)
            self.known = {each: kept for each, kept in self.known.items() if each != name}

    def answer(self, block: list[ast.stmt]) -> str:
        """Return what a block returns; empty if it returns nothing."""
        for statement in block:
            match statement:
                case ast.Return(value=value):
                    return str(self.value(value))
                case ast.If(test=test, body=body, orelse=orelse):
                    if found := self.answer(body if self.tested(test) else orelse):
                        return found
                case ast.Assign(targets=[ast.Name() | ast.Attribute() as target], value=value):
                    self._assign(unparse(target), value)
                case ast.Expr() | ast.Pass() | ast.Global():
                    pass
                case _:
                    raise _Unknown
        return ""


@suspicion
def wrong_answers(tree: ast.AST) -> Iterator[Suspect]:
    """Find a goal callback that refuses a goal that can be done, or accepts one that cannot, and the test for it."""
    first = next((each for each in functions(tree) if each.name == "__init__"), None)
    known = {
        unparse(statement.targets[0]): statement.value
        for statement in (first.body if first is not None else [])
        if isinstance(statement, ast.Assign) and len(statement.targets) == 1
    }
    for function in functions(tree):
        text = unparse(function)
        goal = function.args.args[-1].arg if function.args.args else ""
        if "Response.ACCEPT" not in text or "Response.REJECT" not in text or f"{goal}." not in text:
            continue
        for points, speed, right, about, words in GOALS:
            trial = _Trial(goal, points, speed, known)
            try:
                answer = trial.answer(function.body)
            except (_Unknown, TypeError, ValueError, RecursionError):
                return
            if answer != ("ACCEPT" if right else "REJECT") and trial.tests:
                of = "waypoints" if not points else "speed"
                tests = [each for each in trial.tests if right or f".{of}" in unparse(each[0])] or trial.tests
                test, held = tests[-1]
                yield (
                    test.lineno,
                    about,
                    f"`{unparse(test)[:90]}` is {held} for {words}, so {function.name} "
                    f"{'rejects' if right else 'accepts'} it",
                )
