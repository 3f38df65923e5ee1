"""The places where a Python file reckons simulated time in a way that goes wrong: counted ticks, parts of a time.

A kind of submission that is Python records these places as facts of a run. The diagnosis mentions them only if a check
saw the right thing at the wrong time (`grader/score/clocks.py`).
"""

from __future__ import annotations

import ast
from typing import Any

from gz_course.grader.feedback.facts.syntax import Places, nodes_of, places_in, unparse, walk

MOST = 3  # places reported at most
CLOCKS = frozenset({"get_clock", "stamp", "clock", "monotonic", "time", "Clock", "nanoseconds"})


def time_reckoning(content: bytes) -> Places:
    """Return `line`, `code` and `fault` (`ticks`, `restart`, `nanosec`, `sec`) of each such place.

    A file that is not Python has none.
    Counted ticks are reported only if the file reads no clock: a counter may well serve something else.
    """
    return places_in(content, _places)


def _places(tree: ast.Module) -> Places:
    names = {node.attr for node in nodes_of(tree, ast.Attribute)}
    found = [place for node in walk(tree) if (place := _part(node, names))]
    found += [place for function in _functions(tree) for place in _restarted(function)]
    if not names & CLOCKS:
        found += [place for function in _functions(tree) for place in _counted(function)]
    return sorted(found, key=lambda place: place["line"])[:MOST]


def _functions(tree: ast.AST) -> list[ast.FunctionDef]:
    return [node for node in nodes_of(tree, ast.FunctionDef) if node.name != "__init__"]


def _counted(function: ast.FunctionDef) -> list[dict[str, Any]]:
    """Return where a function adds a constant to a variable that outlives it, outside of loops."""
    looped = {id(inner) for node in nodes_of(function, ast.For, ast.While) for inner in walk(node)}
    kept = {name for node in nodes_of(function, ast.Global, ast.Nonlocal) for name in node.names}
    return [
        _place(node, "ticks")
        for node in walk(function)
        if id(node) not in looped and (target := _adds(node)) is not None
        if isinstance(target, ast.Attribute) or (isinstance(target, ast.Name) and target.id in kept)
    ]


def _restarted(function: ast.FunctionDef) -> list[dict[str, Any]]:
    """Return where a function sets an attribute to a time without a condition and then takes it from that time."""
    found = []
    for node in function.body:
        if not isinstance(node, ast.Assign) or len(node.targets) != 1 or not isinstance(node.targets[0], ast.Attribute):
            continue
        start, now = unparse(node.targets[0]), unparse(node.value)
        if any(
            isinstance(each, ast.BinOp)
            and isinstance(each.op, ast.Sub)
            and (unparse(each.left), unparse(each.right)) == (now, start)
            and each.lineno > node.lineno
            for each in walk(function)
        ):
            found.append(_place(node, "restart"))
    return found


def _adds(node: ast.AST) -> ast.expr | None:
    """Return what `x += 1`, `x -= 1`, `x = x + 1` change by a positive constant; None for other statements."""
    if isinstance(node, ast.AugAssign) and isinstance(node.op, ast.Add | ast.Sub):
        return node.target if isinstance(node.value, ast.Constant | ast.Name | ast.Attribute) else None
    if isinstance(node, ast.Assign) and isinstance(node.value, ast.BinOp) and len(node.targets) == 1:
        same = unparse(node.targets[0]) == unparse(node.value.left)
        if same and isinstance(node.value.op, ast.Add | ast.Sub) and isinstance(node.value.right, ast.Constant):
            return node.targets[0]
    return None


def _part(node: ast.AST, names: set[str]) -> dict[str, Any] | None:
    """Return the place if only one part of a time, its seconds or its nanoseconds, is used in the file."""
    if isinstance(node, ast.Subscript) and unparse(node.value).endswith("seconds_nanoseconds()"):
        index = node.slice.value if isinstance(node.slice, ast.Constant) else None
        return _place(node, "nanosec" if index else "sec") if index in (0, 1) else None
    if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Load):
        if node.attr == "nanosec" and "sec" not in names:
            return _place(node, "nanosec")
        if node.attr == "sec" and "nanosec" not in names:
            return _place(node, "sec")
    return None


def _place(node: Any, fault: str) -> dict[str, Any]:
    return {"line": node.lineno, "code": unparse(node)[:80], "fault": fault}
