"""Suspects in how a speed is limited: `max(limit, speed)` is the limit at least."""

from __future__ import annotations

import ast

from gz_course.grader.feedback.facts.syntax import Words, assigned, calls, last_name, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

LIMITING = ("min", "minimum", "clip", "clamp", "limited", "limit")


@suspicion_of(About.SPEED_LIMIT)
def at_least_the_limit(tree: ast.Module) -> Words:
    """Find a `max` of the parameter speed_limit and a speed, where no `min` or other function limits the result."""
    if "speed_limit" not in unparse(tree):
        return
    names = limit_names(tree)
    inside = {id(node) for call, name in calls(tree) if name in LIMITING for given in call.args for node in walk(given)}
    for call, name in calls(tree):
        if name not in ("max", "maximum") or len(call.args) != 2 or id(call) in inside:
            continue
        for limit in call.args:
            if reads_limit(limit) or unparse(limit) in names:
                yield call, f"{unparse(call)[:60]} is {unparse(limit)[:40]} at least; what limits a speed is min(...)"


def limit_names(tree: ast.AST) -> set[str]:
    """Return the names and attributes that are given the value of the parameter speed_limit."""
    return {
        unparse(target)
        for target, value in assigned(tree)
        if isinstance(target, ast.Name | ast.Attribute) and reads_limit(value)
    }


def reads_limit(node: ast.expr) -> bool:
    """Say whether an expression is the value of the parameter speed_limit alone."""
    if isinstance(node, ast.Attribute):
        return node.attr == "speed_limit" or (node.attr in ("value", "double_value") and reads_limit(node.value))
    if isinstance(node, ast.Call) and last_name(node.func) == "get_parameter_value":
        return isinstance(node.func, ast.Attribute) and reads_limit(node.func.value)
    if isinstance(node, ast.Call) and last_name(node.func) not in (*LIMITING, "max", "abs"):
        return any(isinstance(each, ast.Constant) and each.value == "speed_limit" for each in node.args)
    return False
