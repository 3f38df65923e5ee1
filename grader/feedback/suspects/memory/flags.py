"""Suspects in flags: one that a callback sets to True, that steers the robot, and that nothing sets back."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Words, assigned, functions, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About


@suspicion_of(About.FLAG_FOR_EVER)
def for_ever(tree: ast.Module) -> Words:
    """Find a flag that chooses angular.z, is set to True in a callback of scans, and never to False again."""
    if ".ranges" not in unparse(tree):
        return
    given: dict[str, list[tuple[str, ast.expr, ast.expr]]] = {}
    for function in functions(tree):
        for target, value in assigned(function):
            given.setdefault(unparse(target), []).append((function.name, target, value))
    asked = {unparse(each) for test in _choosing(tree) for each in walk(test)}
    for name, values in given.items():
        later = [(target, value) for function, target, value in values if function != "__init__"]
        ever = bool(later) and all(isinstance(value, ast.Constant) and value.value is True for _, value in later)
        if name.startswith("self.") and name in asked and ever and len(values) > len(later):
            yield later[0][0], f"{name} = True stays so for ever: set it back to False when what it is for is over"


def _choosing(tree: ast.AST) -> Iterator[ast.expr]:
    """Yield the conditions on which a value of angular.z depends."""
    for node in walk(tree):
        if isinstance(node, ast.IfExp) or (isinstance(node, ast.If) and _sets_the_rate(node)):
            yield node.test


def _sets_the_rate(node: ast.If) -> bool:
    return any(unparse(target).endswith("angular.z") for target, _ in assigned(node))
