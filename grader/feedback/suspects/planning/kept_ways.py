"""Suspects in how a robot keeps to its way: it drives where it has none, cuts corners, or forgets walls beside it."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.constants import Number, named_numbers, number
from gz_course.grader.feedback.facts.syntax import Words, assigned, calls, functions, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion, suspicion_of
from gz_course.grader.feedback.suspects.about import About, Suspect

WAY = re.compile(r"path|way|route|plan|frontier|goal|target", re.IGNORECASE)
FAR, FAR_CELLS = 0.8, 8  # [m], [cells] ahead on the way, from where on corners are cut
LARGE = 4  # [cells] around the robot, from where on walls that matter are left out
CELL = 0.1  # [m]
DISTANCES = ("hypot", "dist", "distance", "norm")


@suspicion_of(About.BLIND, ast.If)
def drives_without_a_way(node: ast.If, tree: ast.Module) -> Words:
    """Find `linear.x = 0.3` in the branch for a robot that has no way to follow."""
    known = named_numbers(tree)
    there = _asks_for_a_way(node.test)
    for each in (node.orelse if there else node.body) if there is not None else ():
        for target, value in assigned(each):
            speed = number(value, known)
            if unparse(target).endswith("linear.x") and speed is not None and speed > 0:
                yield (
                    value,
                    f"linear.x is {speed:g} where the robot has no way (line {node.lineno}, "
                    f"`{unparse(node.test)[:60]}`), so it drives ahead without looking where: stand, or turn",
                )


def _asks_for_a_way(test: ast.expr) -> bool | None:
    """Return whether a condition holds if there is a way; None if it asks for something else."""
    match test:
        case ast.UnaryOp(op=ast.Not(), operand=ast.Name() | ast.Attribute() as way) if WAY.search(unparse(way)):
            return False
        case ast.Compare(left=left, ops=[ast.Is() | ast.Eq()], comparators=[ast.Constant(value=None | 0)]):
            return False if WAY.search(unparse(left)) else None
        case ast.Compare(left=left, ops=[ast.IsNot() | ast.Gt() | ast.GtE()], comparators=[ast.Constant()]):
            return True if WAY.search(unparse(left)) else None
        case ast.Name() | ast.Attribute():
            return True if WAY.search(unparse(test)) else None
        case ast.BoolOp(op=ast.And(), values=values):
            return True if any(_asks_for_a_way(each) for each in values) else None
    return None


@suspicion
def aims_far_ahead(tree: ast.Module) -> Iterator[Suspect]:
    """Find an aim that is a metre or more ahead on the way, to which the robot drives straight."""
    known = named_numbers(tree)
    for loop in (each for each in nodes_of(tree, ast.For) if WAY.search(unparse(each.iter))):
        for test in (each.test for each in nodes_of(loop, ast.If)):
            match test:
                case ast.Compare(left=left, ops=[ast.Gt() | ast.GtE()], comparators=[limit]):
                    far = number(limit, known)
                    measured = any(name in DISTANCES for _, name in calls(left)) or "dist" in unparse(left)
                    if measured and far is not None and FAR <= far < 5:
                        yield _far(test, f"{far:g} m", unparse(test))
    for node in nodes_of(tree, ast.Subscript):
        match node.slice:
            case ast.Call(func=ast.Name(id="min"), args=arguments) if WAY.search(unparse(node.value)):
                for each in arguments:
                    far = number(each, known)
                    if far is not None and far >= FAR_CELLS:
                        yield _far(node, f"{far:g} cells", unparse(node))


def _far(node: ast.expr, far: str, code: str) -> Suspect:
    return (
        node.lineno,
        About.FAR_AIM,
        f"`{code[:70]}` aims at a cell {far} ahead on the way, and the robot drives straight to it, which cuts the "
        "corners of the way: aim at one that is 0.3 to 0.5 m ahead",
    )


@suspicion
def walls_left_out(tree: ast.Module) -> Iterator[Suspect]:
    """Find a large square around the robot in which a cell near a wall counts as free."""
    known = named_numbers(tree)
    for function in functions(tree):
        for loop in nodes_of(function, ast.For):
            cells = _reach(loop.iter, known)
            frees = any(name in ("discard", "remove") for _, name in calls(loop)) or any(
                isinstance(target, ast.Subscript) and _is_false(value) for target, value in assigned(loop)
            )
            inner = any(isinstance(each, ast.For) for part in loop.body for each in walk(part))
            if cells >= LARGE and frees and inner:
                yield _left_out(loop, cells, unparse(loop.iter))
        for target, value in assigned(function):
            if isinstance(target, ast.Subscript) and isinstance(target.slice, ast.Tuple) and _is_false(value):
                reaches = [_slice(each, known) for each in target.slice.elts]
                if len(reaches) == 2 and min(reaches) >= LARGE:
                    yield _left_out(target, min(reaches), unparse(target))


def _left_out(node: ast.stmt | ast.expr, cells: Number, code: str) -> Suspect:
    return (
        node.lineno,
        About.LEFT_OUT_WALLS,
        f"`{code[:70]}`: up to {cells:g} cells ({cells * CELL:.1f} m) around the robot, cells near walls count as "
        "free, so its way may touch a wall beside it: 2 cells are enough for a robot to leave a wall",
    )


def _is_false(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and node.value in (False, 0)


def _reach(of: ast.expr, known: dict[str, Number]) -> Number:
    """Return r of `range(-r, r + 1)`; 0 if it is another loop."""
    match of:
        case ast.Call(func=ast.Name(id="range"), args=[first, last]):
            low, high = number(first, known), number(last, known)
            if low is not None and high is not None and high == 1 - low:
                return -low
    return 0


def _slice(of: ast.expr, known: dict[str, Number]) -> Number:
    """Return r of `row - r : row + r + 1`; 0 if it is another slice."""
    match of:
        case ast.Slice(lower=ast.BinOp(left=middle, op=ast.Sub(), right=reach), upper=ast.expr() as upper) if unparse(
            upper
        ).startswith(unparse(middle)):
            return number(reach, known) or 0
    return 0
