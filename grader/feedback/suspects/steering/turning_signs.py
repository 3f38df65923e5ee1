"""Suspects in the side to which a robot turns, where a program decides it by the sign of the error."""

from __future__ import annotations

import ast
import re

from gz_course.grader.feedback.facts.syntax import Words, assigned, called, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About
from gz_course.grader.feedback.suspects.steering.headings import HEADING

WHOLE_TURN = re.compile(r"2(?:\.0)? \* [\w.]*pi|[\w.]*pi \* 2|\btau\b|6\.28")
AIMED = frozenset({"atan2", "arctan2"})


@suspicion_of(About.SIGN)
def wrong_side(tree: ast.AST) -> Words:
    """Find `angular.z = -1.2 if error > 0 else 1.2`, where the error is the direction of the goal minus the heading."""
    pairs = list(assigned(tree))
    aimed = {unparse(target) for target, value in pairs if called(value) & AIMED}
    errors = {unparse(target) for target, value in pairs if _goal_minus_heading(value, aimed)}
    for node in walk(tree):
        if isinstance(node, ast.If):
            sides = [_turn(each) for each in node.body]
        elif isinstance(node, ast.Assign) and isinstance(node.value, ast.IfExp) and _turns(node.targets[0]):
            sides = [node.value.body]
        else:
            continue
        test = node.test if isinstance(node, ast.If) else node.value.test  # type: ignore[attr-defined]
        match test:
            case ast.Compare(left=error, ops=[ast.Gt() | ast.GtE()], comparators=[ast.Constant(value=limit)]):
                side = 1 if isinstance(limit, int | float) and limit >= 0 else 0
            case ast.Compare(left=error, ops=[ast.Lt() | ast.LtE()], comparators=[ast.Constant(value=0)]):
                side = -1
            case _:
                continue
        given = next((each for each in sides if each is not None), None)
        if given is None or unparse(error) not in errors or not side:
            continue
        negative = isinstance(given, ast.UnaryOp) and isinstance(given.op, ast.USub)
        if negative == (side > 0) and (negative or isinstance(given, ast.Constant)):
            goal, turn = ("left", "right") if side > 0 else ("right", "left")
            yield (
                node,
                f"where {unparse(test)}, the goal is on the {goal}, and angular.z becomes {unparse(given)}, "
                f"which turns the robot to the {turn}, away from its goal; a positive angular.z turns to the left",
            )


@suspicion_of(About.WRAP)
def whole_turns(tree: ast.AST) -> Words:
    """Find `error = (atan2(dy, dx) - yaw) % (2 * pi)`, which is never negative, so all turns go to the left."""
    pairs = list(assigned(tree))
    aimed = {unparse(target) for target, value in pairs if called(value) & AIMED}
    text = unparse(tree)
    for target, value in pairs:
        match value:
            case ast.BinOp(left=error, op=ast.Mod(), right=whole):
                pass
            case ast.Call(func=ast.Attribute(attr="mod"), args=[error, whole]):
                pass
            case _:
                continue
        name = unparse(target)
        if not WHOLE_TURN.search(unparse(whole)) or not _goal_minus_heading(error, aimed):
            continue
        if not re.search(rf"{re.escape(name)} (?:>=?|-=?) [\w.]*pi", text):  # what follows may bring it below pi
            yield (
                value,
                f"`{unparse(value)[:80]}` lies between 0 and 2 pi, so a goal a little to the right is nearly a "
                f"whole turn to the left: {name} must lie between -pi and pi, as remainder(..., 2 * pi) does",
            )


def _goal_minus_heading(value: ast.expr, aimed: set[str]) -> bool:
    for node in nodes_of(value, ast.BinOp):
        if isinstance(node.op, ast.Sub):
            left, right = unparse(node.left), unparse(node.right)
            if (called(node.left) & AIMED or left in aimed) and HEADING.search(right) and right not in aimed:
                return True
    return False


def _turns(target: ast.expr) -> bool:
    return unparse(target).endswith("angular.z")


def _turn(statement: ast.stmt) -> ast.expr | None:
    """Return what a statement assigns to angular.z; None if it does not."""
    if isinstance(statement, ast.Assign) and _turns(statement.targets[0]):
        return statement.value
    return None
