"""The counters of a Python file that are compared before they are increased: the first call still sees their start.

A kind of submission that is Python records them as facts; the diagnosis names one only if a check has seen a message
too late, or one too many, by as much as such a counter makes.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import Any

from gz_course.grader.feedback.facts.constants import named_numbers, number
from gz_course.grader.feedback.facts.syntax import Places, assigned, functions, nodes_of, places_in, unparse

MOST = 3  # counters reported at most


def counters(content: bytes) -> Places:
    """Return each comparison of a counter, which begins with 0, above the line that adds 1 to it in its function.

    A place has `line` and `code` of the comparison, the `counter`, the number `limit` and `added`, the line that adds.
    """
    return places_in(content, lambda tree: list(_counters(tree))[:MOST])


def _counters(tree: ast.Module) -> Iterator[dict[str, Any]]:
    numbers = named_numbers(tree)
    from_zero = {
        unparse(target)
        for target, value in assigned(tree)
        if isinstance(value, ast.Constant) and value.value == 0 and not isinstance(value.value, bool)
    }
    for function in functions(tree):
        for added in nodes_of(function, ast.AugAssign, ast.Assign):
            counter = _increased(added)
            if counter.removeprefix("self.") not in from_zero and counter not in from_zero:
                continue
            for test in nodes_of(function, ast.Compare):
                if len(test.ops) != 1 or test.lineno >= added.lineno:
                    continue
                limit = number(test.comparators[0], numbers)
                if unparse(test.left) == counter and limit is not None:
                    yield {
                        "line": test.lineno,
                        "code": unparse(test)[:80],
                        "counter": counter,
                        "limit": float(limit),
                        "added": added.lineno,
                    }


def _increased(node: ast.AugAssign | ast.Assign) -> str:
    """Return the counter to which a statement adds 1; empty if it is another statement."""
    target = unparse(node.target if isinstance(node, ast.AugAssign) else node.targets[0])
    if isinstance(node, ast.AugAssign) and isinstance(node.op, ast.Add):
        step = node.value
    elif isinstance(node.value, ast.BinOp) and isinstance(node.value.op, ast.Add):
        step = node.value.right if unparse(node.value.left) == target else node.value
    else:
        return ""
    return target if isinstance(step, ast.Constant) and step.value == 1 else ""
