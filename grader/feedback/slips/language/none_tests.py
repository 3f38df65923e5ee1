"""Callbacks that return when what they need is there, because the test for None is the wrong way round."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Words, unparse, walk
from gz_course.grader.feedback.slips import slip_of


@slip_of(ast.FunctionDef)
def returns_when_there(function: ast.FunctionDef) -> Words:
    """Find `if self.x is not None: return` before lines that use parts of `self.x`, which is None there."""
    for place, node in enumerate(function.body):
        if not isinstance(node, ast.If) or node.orelse or unparse(node.body[-1]) not in ("return", "return None"):
            continue
        for name in _there(node.test):
            if _uses(function.body[place + 1 :], name):
                yield (
                    node,
                    f"{function.name} returns here when {name} is there, and the lines below use it, where it is "
                    f"None: if {name} is None",
                )


def _there(test: ast.expr) -> Iterator[str]:
    """Yield the attributes of self of which one that is not None makes a condition true."""
    if isinstance(test, ast.BoolOp) and isinstance(test.op, ast.Or):
        for each in test.values:
            yield from _there(each)
    elif isinstance(test, ast.Compare) and isinstance(test.ops[0], ast.IsNot):
        name, none = unparse(test.left), unparse(test.comparators[0])
        yield from [name] if none == "None" and name.startswith("self.") else []


def _uses(body: list[ast.stmt], name: str) -> bool:
    """Return whether statements use parts of an attribute before one of them sets it."""
    for statement in body:
        nodes = list(walk(statement))
        if any(isinstance(node, ast.Attribute) and _stores(node, name) for node in nodes):
            return False
        for node in nodes:
            parts = isinstance(node, ast.Attribute | ast.Subscript) and unparse(node.value) == name
            unpacked = (
                isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Tuple) and unparse(node.value) == name
            )
            if parts or unpacked:
                return True
    return False


def _stores(node: ast.Attribute, name: str) -> bool:
    return isinstance(node.ctx, ast.Store) and unparse(node) == name
