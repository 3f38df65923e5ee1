"""Rates of change and sums over time that are taken with a time in nanoseconds."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Place, assigned, calls, functions, last_name, nodes_of, unparse
from gz_course.grader.feedback.slips import slip

IN_SECONDS = re.compile(r"1e-?0?9|10\s*\*\*\s*-?9|1_?000_?000_?000(?:\.0)?|1000000000")
ERROR = re.compile(r"err|diff|dev", re.IGNORECASE)


@slip
def per_nanosecond(tree: ast.AST) -> Iterator[Place]:
    """Find `(error - last_error) / dt` and `total += error * dt` where dt is a difference of nanoseconds."""
    text = unparse(tree)
    if ".nanoseconds" not in text or IN_SECONDS.search(text) or re.search(r"\b1000000000(?:\.0)?\b", text):
        return
    times = _times(tree)
    values = {unparse(target): value for target, value in assigned(tree)}
    spans = {name: value for name, value in values.items() if _is_span(value, times)}
    for node in nodes_of(tree, ast.BinOp):
        if not isinstance(node.op, ast.Div | ast.Mult):
            continue
        for one, span in ((node.left, node.right), (node.right, node.left)):
            if isinstance(node.op, ast.Div) and span is node.left:
                continue
            name = unparse(span)
            if name not in spans and not _is_span(span, times):
                continue
            amount = values.get(unparse(one), one)
            change = isinstance(amount, ast.BinOp) and isinstance(amount.op, ast.Sub) and not _is_span(amount, times)
            if change or ERROR.search(unparse(one)):
                how = "small" if isinstance(node.op, ast.Div) else "large"
                yield (
                    node.lineno,
                    f"{unparse(node)[:60]}: {name[:40]} is in nanoseconds, so this is 1e9 times too {how}; divide "
                    "the time by 1e9 first, for seconds",
                )
                return


def _times(tree: ast.AST) -> set[str]:
    """Return the names that hold a number of nanoseconds, also as the arguments of the file's own functions."""
    own = {
        function.name: [each.arg for each in function.args.args if each.arg != "self"] for function in functions(tree)
    }
    found: set[str] = set()
    for _ in range(2):
        for target, value in assigned(tree):
            if _is_time(value, found):
                found.add(unparse(target))
        for call, _name in calls(tree):
            for name, value in zip(own.get(last_name(call.func), []), call.args, strict=False):
                if _is_time(value, found):
                    found.add(name)
    return found


def _is_time(value: ast.expr, found: set[str]) -> bool:
    return (isinstance(value, ast.Attribute) and value.attr == "nanoseconds") or unparse(value) in found


def _is_span(value: ast.expr, times: set[str]) -> bool:
    """Say whether an expression is how much time has passed, in nanoseconds."""
    if isinstance(value, ast.Attribute) and value.attr == "nanoseconds":
        return isinstance(value.value, ast.BinOp) and isinstance(value.value.op, ast.Sub)
    return isinstance(value, ast.BinOp) and isinstance(value.op, ast.Sub) and _is_time(value.left, times)
