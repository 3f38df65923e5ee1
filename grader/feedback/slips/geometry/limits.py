"""Limits of a value whose lower and upper bound are exchanged, so that the value itself never counts."""

from __future__ import annotations

import ast

from gz_course.grader.feedback.facts.constants import named_numbers, number
from gz_course.grader.feedback.facts.syntax import Words, last_name, unparse
from gz_course.grader.feedback.slips import slip_of

OTHER = {"min": "max", "max": "min"}
LIMITS = 2  # arguments of min and of max


@slip_of(ast.Call)
def exchanged(call: ast.Call, tree: ast.AST) -> Words:
    """Find `min(-most, max(most, value))`, which is always `-most`, and `np.clip(value, most, -most)`."""
    known = named_numbers(tree)
    name = last_name(call.func)
    if name == "clip" and len(call.args) == LIMITS + 1 and _below(call.args[2], call.args[1], known):
        yield f"{unparse(call)[:60]} has its limits exchanged: the lower one comes first, clip(value, low, high)"
    if name not in OTHER or len(call.args) != LIMITS or call.keywords:
        return
    for outer, inner in (call.args, call.args[::-1]):
        if not isinstance(inner, ast.Call) or last_name(inner.func) != OTHER[name] or len(inner.args) != LIMITS:
            continue
        for bound in inner.args:
            pair = (outer, bound) if name == "min" else (bound, outer)
            if _below(*pair, known):
                yield (
                    f"{unparse(call)[:60]} is always {unparse(outer)}, whatever the value is: its limits "
                    "are exchanged, it must be max(low, min(high, value))"
                )


def _below(low: ast.expr, high: ast.expr, known: dict[str, int | float]) -> bool:
    """Say whether one limit is certainly below the other: numbers, or a name with a minus and the same without."""
    first, second = number(low, known), number(high, known)
    if first is not None and second is not None:
        return first < second
    negative = isinstance(low, ast.UnaryOp) and isinstance(low.op, ast.USub)
    return negative and unparse(low) == f"-{unparse(high)}" and isinstance(high, ast.Name | ast.Attribute)
