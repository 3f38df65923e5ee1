"""Suspects in searches with a heap: what comes out first is not the cell with the least cost."""

from __future__ import annotations

import ast

from gz_course.grader.feedback.facts.syntax import Words, assigned, calls, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

NAMES = frozenset({"heappush", "put"})


@suspicion_of(About.SEARCH, ast.FunctionDef)
def other_first(function: ast.FunctionDef) -> Words:
    """Find `heappush(heap, (cell, cost))` and `heappush(heap, (-cost, cell))`."""
    values = {unparse(target): value for target, value in assigned(function)}
    keys = _keys(function)
    for call, name in calls(function):
        pushed = call.args[-1] if name in NAMES and call.args else None
        if not isinstance(pushed, ast.Tuple) or len(pushed.elts) < 2 or not _in_a_search(function, call):
            continue
        first, rest = pushed.elts[0], pushed.elts[1:]
        texts = [unparse(each) for each in (pushed, first)]
        if _negative(first, values):
            yield (
                call,
                f"{texts[0]} is put into a heap with {texts[1]}, a cost with a minus, and a heap gives out the "
                "least first: the search goes to the farthest cells first; put the cost itself in front",
            )
        elif (isinstance(first, ast.Tuple) or texts[1] in keys) and any(_is_a_cost(each, values) for each in rest):
            yield (
                call,
                f"{texts[0]} begins with the cell {texts[1]}, and a heap is ordered by what stands first: the "
                "search goes to the lowest row or column first, not to the nearest cell; put the cost in front",
            )


def _in_a_search(function: ast.FunctionDef, call: ast.Call) -> bool:
    """Return whether a call stands in a loop that takes out what is put in."""
    loops = nodes_of(function, ast.While)
    takes = ("heappop(", ".get()", ".get_nowait()")
    return any(call in walk(loop) and any(each in unparse(loop) for each in takes) for loop in loops)


def _keys(function: ast.FunctionDef) -> set[str]:
    """Return the names by which something is looked up: `cost[cell]`, `cell in done`, `done.add(cell)`."""
    found = {unparse(each.slice) for each in nodes_of(function, ast.Subscript)}
    for each in nodes_of(function, ast.Compare):
        if isinstance(each.ops[0], ast.In | ast.NotIn):
            found.add(unparse(each.left))
    return found | {unparse(call.args[0]) for call, name in calls(function) if name in ("add", "get") and call.args}


def _negative(node: ast.expr, values: dict[str, ast.expr]) -> bool:
    value = values.get(unparse(node), node)
    return (
        isinstance(value, ast.UnaryOp)
        and isinstance(value.op, ast.USub)
        and not isinstance(value.operand, ast.Constant)
    )


def _is_a_cost(node: ast.expr, values: dict[str, ast.expr]) -> bool:
    value = values.get(unparse(node), node)
    return isinstance(value, ast.BinOp) and isinstance(value.op, ast.Add)
