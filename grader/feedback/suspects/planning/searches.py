"""Suspects in what a search goes to: frontiers that are none, the wrong cell of a heap, goals as the crow flies."""

from __future__ import annotations

import ast
import re

from gz_course.grader.feedback.facts.syntax import (
    Words,
    assigned,
    called,
    calls,
    functions,
    last_name,
    nodes_of,
    unparse,
    walk,
)
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

UNKNOWN = ("-1", "UNKNOWN", "self.UNKNOWN", "unknown")
SIDES = 3  # at least, of the four neighbours of a cell
NAMES = frozenset({"heappush", "put"})
NEAREST = frozenset({"min", "argmin", "sorted", "argsort", "sort"})
DISTANCE = re.compile(r"\bhypot\(|\bnorm\(|\bdist(?:ance)?\(|\*\* 2")
TAKES = frozenset({"pop", "popleft", "heappop", "get", "get_nowait"})


@suspicion_of(About.WAY)
def unknown_on_all_sides(tree: ast.AST) -> Words:
    """Find `all(value(cell) == -1 for cell in neighbours)`, or as many comparisons joined by `and`."""
    if "OccupancyGrid" not in unparse(tree):
        return
    denied = {id(n.operand) for n in nodes_of(tree, ast.UnaryOp) if isinstance(n.op, ast.Not)}
    for node in walk(tree):
        match node:
            case ast.Call(func=func, args=[ast.GeneratorExp() | ast.ListComp() as each]) if last_name(func) == "all":
                asked = _is_unknown(each.elt)
            case ast.BoolOp(op=ast.And(), values=values):
                asked = sum(isinstance(each, ast.Compare) and _is_unknown(each) for each in values) >= SIDES
            case _:
                continue
        if asked and id(node) not in denied:
            yield (
                node,
                f"`{unparse(node)[:80]}` asks for unknown cells on every side, and a free cell that a ray has reached "
                "has a free one on the side where the ray came from: one unknown neighbour makes a frontier, any(...)",
            )


def _is_unknown(node: ast.expr) -> bool:
    """Return whether a condition, or one of several that must hold, is that a cell is unknown."""
    if isinstance(node, ast.BoolOp) and isinstance(node.op, ast.And):
        return any(_is_unknown(each) for each in node.values)
    match node:
        case ast.Compare(ops=[ast.Eq()], comparators=[value]):
            return unparse(value) in UNKNOWN
        case ast.Compare(ops=[ast.Lt()], comparators=[ast.Constant(value=0)]):
            return True
    return False


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


@suspicion_of(About.STRAIGHT)
def straight_goals(tree: ast.AST) -> Words:
    """Find the nearest of several cells as the crow flies, where no loop takes cells out of a queue."""
    loops = nodes_of(tree, ast.While, ast.For)
    if any(called(loop) & TAKES and called(loop) & {"append", "heappush", "put", "add"} for loop in loops):
        return
    if "OccupancyGrid" not in unparse(tree):
        return
    if re.search(r"dijkstra|a_?star|bfs|wave|flood|shortest_path|potential", unparse(tree), re.IGNORECASE):
        return
    for function in functions(tree):
        distances = {unparse(target) for target, value in assigned(function) if DISTANCE.search(unparse(value))}
        for call, name in calls(function):
            given = [*call.args, *(each.value for each in call.keywords)]
            if name not in NEAREST or not given:
                continue
            text = " ".join(unparse(each) for each in given)
            keys = [last_name(each.value) for each in call.keywords if each.arg == "key"]
            own = any(one.name in keys and DISTANCE.search(unparse(one)) for one in functions(tree))
            if "ranges" not in text and (DISTANCE.search(text) or text in distances or own):
                yield (
                    call,
                    f"{unparse(call)[:60]} takes the goal that is nearest in a straight line, and nothing searches "
                    "a way to it: a wall may stand between; search through free cells, breadth first",
                )
