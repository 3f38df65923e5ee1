"""Suspects in functions that say by what they return that a goal was cancelled, and in callers that do not listen."""

from __future__ import annotations

import ast

from gz_course.grader.feedback.facts.syntax import Words, last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

ASKS = "is_cancel_requested"


def _answers(function: ast.FunctionDef) -> tuple[str, str] | None:
    """Return what a function returns where a goal is to be cancelled, and otherwise; None if that is the same."""
    asked = [
        each for each in nodes_of(function, ast.If) if ASKS in unparse(each.test)
    ]  # fmt: skip
    inside = [part for each in asked for part in each.body if isinstance(part, ast.Return)]
    others = [each for each in nodes_of(function, ast.Return) if each not in inside]
    if not inside or inside[0].value is None:
        return None
    then = unparse(inside[0].value)
    otherwise = [unparse(each.value) for each in others if each.value is not None]
    constant = isinstance(inside[0].value, ast.Constant)
    return (then, otherwise[0]) if constant and otherwise and then != otherwise[0] else None


@suspicion_of(About.CANCEL, ast.FunctionDef)
def answers_thrown_away(function: ast.FunctionDef, tree: ast.AST) -> Words:
    """Find `self.drive_to(point)` as a statement, where drive_to returns whether the goal was cancelled."""
    answer = _answers(function)
    if answer is None:
        return
    for node in walk(tree):
        call = node.value if isinstance(node, ast.Expr) else None
        if isinstance(call, ast.Call) and last_name(call.func) == function.name:
            yield (
                call,
                f"{unparse(call.func)}() returns {answer[0]} when the goal is to be cancelled, and this line "
                "throws that away, so execute goes on as if the waypoint were reached: ask what it returns, and "
                "end the patrol there",
            )
