"""Suspects in where a robot aims: without its heading, without the corner of the map, x for y, the other branch."""

from __future__ import annotations

import ast
import re

from gz_course.grader.feedback.facts.syntax import Words, assigned, calls, functions, last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About
from gz_course.grader.feedback.suspects.planning.own_places import CORNER_X, CORNER_Y, X, Y
from gz_course.grader.feedback.suspects.planning.ways import AIMED

HEADINGS = re.compile(r"err|angle|diff|delta|turn|bearing|heading|yaw|theta", re.IGNORECASE)


@suspicion_of(About.CELL, ast.Call)
def crossed(call: ast.Call) -> Words:
    """Find `hypot(x - pose.y, y - pose.x)`."""
    name = last_name(call.func)
    if name not in (AIMED | {"hypot"}) or len(call.args) != 2:
        return
    pairs = [(each.left, each.right) for each in call.args if isinstance(each, ast.BinOp) and _is_difference(each)]
    axes = [tuple(_axis(side) for side in pair) for pair in pairs]
    if axes in ([("x", "y"), ("y", "x")], [("y", "x"), ("x", "y")]):
        yield f"{unparse(call)[:70]} subtracts y from x and x from y: x belongs to x, and y to y"


def _is_difference(node: ast.AST) -> bool:
    return isinstance(node, ast.BinOp) and isinstance(node.op, ast.Sub)


@suspicion_of(About.SIGN)
def other_branch(tree: ast.AST) -> Words:
    """Find `if abs(error) < 0.5:` with a turn on the spot below it, and with the drive in the other branch."""
    for node in (each for each in nodes_of(tree, ast.If) if each.orelse):
        match node.test:
            case ast.Compare(
                left=ast.Call(func=func, args=[error]), ops=[ast.Lt() | ast.LtE() | ast.Gt() | ast.GtE() as op]
            ) if unparse(func).rpartition(".")[2] in ("abs", "fabs"):
                small = node.body if isinstance(op, ast.Lt | ast.LtE) else node.orelse
                large = node.orelse if small is node.body else node.body
            case _:
                continue
        if HEADINGS.search(unparse(error)) and _drives(large) and not _drives(small) and _turns(small):
            yield (
                node,
                f"`{unparse(node.test)[:60]}`: the robot turns on the spot while {unparse(error)} is small, "
                "and drives while it is large: the two branches, or < and >, are exchanged",
            )


def _drives(block: list[ast.stmt]) -> bool:
    sets = [pair for each in block for pair in assigned(each)]
    return any(unparse(one).endswith("linear.x") and unparse(value) not in ("0", "0.0") for one, value in sets)


def _turns(block: list[ast.stmt]) -> bool:
    return any(unparse(one).endswith("angular.z") for each in block for one, _ in assigned(each))


@suspicion_of(About.SIGN, ast.FunctionDef)
def without_heading(function: ast.FunctionDef) -> Words:
    """Find `error = atan2(goal_y - y, goal_x - x)`, by which angular.z turns, although no heading is taken off it."""
    turns = [value for target, value in assigned(function) if unparse(target).endswith("angular.z")]
    for target, value in assigned(function):
        aimed = [call for call, name in calls(value) if name in AIMED and len(call.args) == 2]
        if len(aimed) != 1 or not all(isinstance(each, ast.BinOp) for each in aimed[0].args):
            continue
        name = unparse(target)
        inside = {id(each) for each in walk(aimed[0])}
        taken_off = any(_is_difference(each) for each in walk(value) if id(each) not in inside)
        later = any(_is_difference(each) and name in map(unparse, walk(each)) for each in walk(function)) or any(
            unparse(each.target) == name for each in nodes_of(function, ast.AugAssign)
        )
        used = any(name in map(unparse, walk(each)) for each in turns)
        if used and not taken_off and not later:
            yield (
                value,
                f"{unparse(aimed[0])[:70]} is the direction of the goal in odom, and angular.z turns by it as "
                "if the robot looked along x: subtract the heading of the robot, and wrap the difference",
            )


def _axis(node: ast.expr) -> str:
    text = unparse(node)
    return "x" if X.search(text) else "y" if Y.search(text) else ""


@suspicion_of(About.CELL)
def without_corner(tree: ast.AST) -> Words:
    """Find `(column + 0.5) * resolution` in a function that adds no corner, in a file that subtracts one from x."""
    subtracts = any(
        isinstance(node, ast.BinOp)
        and isinstance(node.op, ast.Sub)
        and (CORNER_X.search(unparse(node.right)) or CORNER_Y.search(unparse(node.right)))
        for node in walk(tree)
    )
    for function in functions(tree) if subtracts else ():
        text = unparse(function)
        if CORNER_X.search(text) or CORNER_Y.search(text) or "origin" in text.lower():
            continue
        for node in walk(function):
            match node:
                case ast.BinOp(
                    left=ast.BinOp(left=cell, op=ast.Add(), right=ast.Constant(value=0.5)),
                    op=ast.Mult(),
                    right=ast.Name() | ast.Attribute() | ast.Constant(),
                ):
                    yield (
                        node,
                        f"{unparse(node)[:60]} is how far cell {unparse(cell)} is from the corner of the map: "
                        "add the corner to have a place in odom",
                    )
                    return
