"""Suspects in where a robot aims: without its heading or the corner, x for y, the wrong end of its way."""

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
from gz_course.grader.feedback.suspects.planning.cells import CORNER_X, CORNER_Y, X, Y
from gz_course.grader.feedback.suspects.planning.ways import AIMED, SHORTENS, TURNS_ROUND, never_shortened

BEFORE = ("flags",)

HEADINGS = re.compile(r"err|angle|diff|delta|turn|bearing|heading|yaw|theta", re.IGNORECASE)
COLLECTS = frozenset({"append", "insert", "appendleft"})


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


@suspicion_of(About.WAY)
def ends_of_a_way(tree: ast.Module) -> Words:
    """Find a file that reads only the first, or only the last, cell of a way that it searched from start to goal."""
    if any(never_shortened(tree)):
        return  # which says more
    for owner in nodes_of(tree, ast.ClassDef):
        for way in {unparse(target) for target, value in assigned(owner) if _is_a_list(target, value)}:
            makers = [each for each in functions(owner) if each.name != "__init__" and _makes(each, way)]
            if not makers and any(unparse(one) == way and isinstance(of, ast.Call) for one, of in assigned(owner)):
                makers = [each for each in functions(tree) if _follows_back(each)]
            turned = any(called(each) & TURNS_ROUND or "[::-1]" in unparse(each) for each in makers)
            changed = any(unparse(call.func) in {f"{way}.{name}" for name in SHORTENS} for call, name in calls(owner))
            cut = any(f"{way}[1:]" in unparse(each) or "[1:]" in unparse(each) for each in functions(owner))
            read = [
                node
                for node in nodes_of(owner, ast.Subscript)
                if unparse(node.value) == way and isinstance(node.ctx, ast.Load)
            ]
            kinds = {unparse(node.slice) for node in read}
            looped = any(unparse(each.iter) == way for each in nodes_of(owner, ast.For))
            if not makers or not turned or changed or cut or len(kinds) != 1 or looped:
                continue
            if kinds == {"0"}:
                yield (
                    read[0],
                    f"{way}[0] is the first cell of the way, in which the robot stands already, so it has no "
                    "direction to steer to: steer to a cell further along, and take out those that are reached",
                )
            elif kinds == {"-1"}:
                yield (
                    read[0],
                    f"{way}[-1] is the end of the way, and the robot steers straight to it, through what the way goes "
                    "round: follow the cells of the way one after another",
                )


def _is_a_list(target: ast.expr, value: ast.expr) -> bool:
    return isinstance(target, ast.Attribute) and isinstance(value, ast.List) and not value.elts


def _makes(function: ast.FunctionDef, way: str) -> bool:
    """Return whether a function collects a way back from its goal: `cell = before[cell]` in a loop."""
    return any(unparse(target) == way for target, _ in assigned(function)) and _follows_back(function)


def _follows_back(function: ast.FunctionDef) -> bool:
    return bool(called(function) & COLLECTS) and any(
        isinstance(value, ast.Subscript) and unparse(value.slice) == unparse(target)
        for loop in nodes_of(function, ast.While)
        for target, value in assigned(loop)
    )


@suspicion_of(About.WAY, ast.While, ast.If)
def other_end_taken(node: ast.While | ast.If) -> Words:
    """Find `self.way.pop()` after a test of `self.way[0]`: the last cell is taken out, not the one that is reached."""
    for call, name in (pair for part in node.body for pair in calls(part)):
        way = unparse(call.func).rpartition(".")[0]
        whole = unparse(node.test)
        if name == "pop" and not call.args and f"{way}[0]" in whole and f"{way}[-1]" not in whole:
            yield (
                call,
                f"{unparse(call)} takes the last cell out of the way, and `{whole[:50]}` is about the first "
                f"one: {way}.pop(0) takes out what is reached",
            )


@suspicion_of(About.WAY, ast.ClassDef)
def left_in_the_first_pass(owner: ast.ClassDef) -> Words:
    """Find a loop over a way that returns, or breaks, in its first pass whatever the cell is."""
    ways = {unparse(target) for target, value in assigned(owner) if _is_a_list(target, value)}
    for loop in nodes_of(owner, ast.For):
        early = any(isinstance(each, ast.Continue) for each in walk(loop))
        if unparse(loop.iter) in ways and isinstance(loop.body[-1], ast.Return | ast.Break) and not early:
            yield (
                loop,
                f"the loop over {unparse(loop.iter)} ends in its first pass (line {loop.body[-1].lineno}), so "
                "it always takes the first cell of the way, in which the robot stands: a condition must say which "
                "cell is far enough",
            )
