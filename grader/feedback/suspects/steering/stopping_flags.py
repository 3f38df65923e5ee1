"""Suspects in flags that stop a robot and are never set back."""

from __future__ import annotations

import ast

from gz_course.grader.feedback.facts.syntax import Words, assigned, called, functions, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

BEFORE = ("endless_drives", "sleeps")


@suspicion_of(About.STOPPED)
def stops_for_ever(tree: ast.AST) -> Words:
    """Find `self.arrived = True` that nothing sets back, where `if self.arrived` returns or sends no speed."""
    if "ActionServer" in called(tree):
        return  # a goal that is done stays done
    given: dict[str, list[tuple[str, ast.expr]]] = {}
    for function in functions(tree):
        for target, value in assigned(function):
            if (name := unparse(target)).startswith("self."):
                given.setdefault(name, []).append((function.name, value))
    for name, values in given.items():
        begun = [value for where, value in values if where == "__init__"]
        later = [value for where, value in values if where != "__init__"]
        if not begun or not later or not all(_is(value, False) for value in begun):
            continue
        if all(_is(value, True) for value in later) and (stop := _stop(tree, name)):
            yield (
                later[0],
                f"{name} becomes True here, and nothing sets it back to False: from then on line {stop} keeps the "
                "robot where it is, however far it is behind",
            )


def _is(value: ast.expr, wanted: bool) -> bool:
    return isinstance(value, ast.Constant) and value.value is wanted


def _stop(tree: ast.AST, name: str) -> int:
    """Return the line in which a flag that is set lets a function return, or sets a speed of zero; 0 if none does."""
    driving = (f for f in functions(tree) if any(unparse(t).endswith("linear.x") for t, _ in assigned(f)))
    for node in (each for function in driving for each in walk(function)):
        if isinstance(node, ast.IfExp) and unparse(node.test) == name and _zero(node.body):
            return node.lineno
        if not isinstance(node, ast.If) or not _asks(node.test, name):
            continue
        returns = any(isinstance(each, ast.Return) for each in node.body)
        speeds = [
            value for part in node.body for target, value in assigned(part) if unparse(target).endswith("linear.x")
        ]
        empty = returns and not speeds and ("publish" not in called(node) or "Twist()" in unparse(node))
        if empty or (speeds and all(_zero(each) for each in speeds)):
            return node.lineno
    return 0


def _asks(test: ast.expr, name: str) -> bool:
    """Return whether a condition holds as soon as a flag is set."""
    if isinstance(test, ast.BoolOp) and isinstance(test.op, ast.Or):
        return any(_asks(each, name) for each in test.values)
    return unparse(test) in (name, f"{name} is True", f"{name} == True")


def _zero(value: ast.expr) -> bool:
    return isinstance(value, ast.Constant) and value.value == 0 and value.value is not False
