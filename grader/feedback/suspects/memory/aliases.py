"""Suspects in what works on a second name of an array, as if an assignment made a copy."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Words, called, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About


@suspicion_of(About.ALIAS, ast.FunctionDef)
def aliases(function: ast.FunctionDef) -> Words:
    """Find `grid = self.map` followed by `grid[...] = ...` in a function that publishes no map."""
    for node in nodes_of(function, ast.Assign):
        if len(node.targets) != 1:
            continue
        target, value = node.targets[0], node.value
        if isinstance(target, ast.Name) and isinstance(value, ast.Attribute) and _own(value):
            for changed in _changes(function, target.id, node.lineno):
                yield (
                    changed,
                    f"{unparse(changed)[:70]} changes {unparse(value)} itself, because {target.id} = "
                    f"{unparse(value)} in line {node.lineno} makes no copy: {unparse(value)}.copy()",
                )


def _own(value: ast.Attribute) -> bool:
    return isinstance(value.value, ast.Name) and value.value.id == "self"


def _changes(function: ast.FunctionDef, name: str, line: int) -> Iterator[ast.stmt]:
    """Yield the statements after a line that set parts of an array, or change it in place."""
    for node in walk(function):
        target = node.targets[0] if isinstance(node, ast.Assign) else getattr(node, "target", None)
        if not isinstance(node, ast.Assign | ast.AugAssign) or node.lineno <= line or target is None:
            continue
        part = isinstance(target, ast.Subscript) and unparse(target.value) == name
        if part or (isinstance(node, ast.AugAssign) and unparse(target) == name and bool(called(node.value))):
            yield node
