"""Suspects in what counts as a frontier: a cell with unknown ones on all sides, which the robot never has before it."""

from __future__ import annotations

import ast

from gz_course.grader.feedback.facts.syntax import Words, last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

UNKNOWN = ("-1", "UNKNOWN", "self.UNKNOWN", "unknown")
SIDES = 3  # at least, of the four neighbours of a cell


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
