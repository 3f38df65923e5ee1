"""Suspects in counted calls: what is done only in every tenth call of a callback."""

from __future__ import annotations

import ast

from gz_course.grader.feedback.facts.constants import named_numbers, number
from gz_course.grader.feedback.facts.syntax import Words, calls, functions, nodes_of, unparse
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

FEWEST = 2


@suspicion_of(About.EVERY, ast.FunctionDef)
def every_nth_call(function: ast.FunctionDef, tree: ast.Module) -> Words:
    """Find `if self.scans % 10 == 0:`, and `if self.scans >= 10:` that sets the counter to 0, of a counter of calls."""
    numbers = named_numbers(tree)
    counters = {
        unparse(node.target): node.lineno
        for node in nodes_of(function, ast.AugAssign)
        if isinstance(node.op, ast.Add) and unparse(node.value) == "1"
    }
    zeroed = {unparse(node.targets[0]) for node in nodes_of(function, ast.Assign) if unparse(node.value) == "0"}
    for node in nodes_of(function, ast.If):
        match node.test:
            case (
                ast.BinOp(op=ast.Mod(), left=counter, right=limit)
                | ast.Compare(left=ast.BinOp(op=ast.Mod(), left=counter, right=limit))
            ):
                counted = unparse(counter) in counters
            case ast.Compare(left=counter, ops=[ast.GtE() | ast.Eq() | ast.Lt()], comparators=[limit]):
                counted = unparse(counter) in zeroed and counters.get(unparse(counter), 1e9) < node.lineno
            case _:
                continue
        times = number(limit, numbers)
        if counted and times is not None and times >= FEWEST and _publishes(function, tree):
            yield node, f"{unparse(node.test)[:60]} lets only one in {times:g} calls of {function.name} publish"


def _publishes(function: ast.FunctionDef, tree: ast.Module) -> bool:
    """Return whether a function publishes, itself or through a function that it calls."""
    speak = {each.name for each in functions(tree) if any(name == "publish" for _, name in calls(each))}
    return any(name == "publish" or name in speak for _, name in calls(function))
