"""Suspects in parts of a scan that are chosen by a share of the number of rays: `ranges[n // 4 : n // 2]`."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.constants import named_numbers, number
from gz_course.grader.feedback.facts.syntax import assigned, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion
from gz_course.grader.feedback.suspects.about import About, Suspect

RAYS = 720.0
OTHER = {"left": "right", "right": "left"}


@suspicion
def other_side(tree: ast.Module) -> Iterator[Suspect]:
    """Find a part for one side that looks to the other, in a scan that begins behind the robot."""
    if ".ranges" not in unparse(tree):
        return
    known = dict(named_numbers(tree))
    for target, value in assigned(tree):
        if isinstance(value, ast.Call) and unparse(value.func) == "len" and value.args:
            known[unparse(target)] = RAYS
    for side, block in _sides(tree):
        for node in (each for statement in block for each in walk(statement)):
            if not isinstance(node, ast.Subscript) or not isinstance(node.slice, ast.Slice) or node.slice.step:
                continue
            ends = _share(node.slice.lower, known, 0.0), _share(node.slice.upper, known, 1.0)
            if None in ends or ends == (0.0, 1.0):
                continue
            start, end = (360 * share - 180 for share in ends if share is not None)
            if (start + end) * (1 if side == "left" else -1) <= -80 and end > start:
                yield (
                    node.lineno,
                    About.PART.of(side),
                    f"{unparse(node)[:60]} is taken for the {side}, and looks to the {OTHER[side]}, from "
                    f"{start:.0f} to {end:.0f} degrees: angle_min is -pi, so ray 0 looks behind, the ray at a quarter "
                    "to the right, at a half ahead and at three quarters to the left",
                )


def _sides(tree: ast.AST) -> Iterator[tuple[str, list[ast.stmt]]]:
    """Yield the side of each branch that is taken on one side only, and its statements."""
    for node in nodes_of(tree, ast.If):
        if not node.orelse:
            continue
        match node.test:
            case ast.Compare(ops=[ast.Eq()], comparators=[ast.Constant(value="left" | "right" as side)]):
                yield from ((side, node.body), (OTHER[side], node.orelse))
            case ast.Compare(
                left=ast.Name(id="s" | "sign" | "side"), ops=[ast.Gt()], comparators=[ast.Constant(value=0)]
            ):
                yield from (("left", node.body), ("right", node.orelse))


def _share(node: ast.expr | None, known: dict[str, float], absent: float) -> float | None:
    """Return the place of a ray as a share of all rays; None if it is not one."""
    if node is None:
        return absent
    if "len(" in unparse(node):
        node = _Lengths().visit(ast.parse(unparse(node), mode="eval")).body
    elif not any(isinstance(each, ast.Name) and known.get(each.id) == RAYS for each in walk(node)):
        return None
    value = number(node, known)
    return None if value is None or not 0 <= value <= RAYS else value / RAYS


class _Lengths(ast.NodeTransformer):
    """Puts a number in the place of each len(...)."""

    def visit_Call(self, node: ast.Call) -> ast.AST:
        return ast.Constant(value=RAYS) if unparse(node.func) == "len" else node
