"""Suspects in the condition by which a place counts as reached: one coordinate, or a square of a distance."""

from __future__ import annotations

import ast
import re

from gz_course.grader.feedback.facts.constants import named_numbers, number
from gz_course.grader.feedback.facts.syntax import (
    Words,
    assigned,
    called,
    functions,
    last_name,
    nodes_of,
    unparse,
    walk,
)
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

SIZES = frozenset({"abs", "fabs", "absolute"})
COORDINATE = re.compile(r"(?:.*_)?(?:d|e|delta|diff|err|error|gap|off|rest)?_?([xy])(?:_.*)?")
SIGNED = re.compile(r"(?:.*_)?(?:d|delta|diff|err|error)_?[xy]")  # what a difference of coordinates is called
LENGTH = re.compile(r"\b(?:hypot|dist|norm|sqrt)\(|\b(?:\w+_)?(?:distance|dist)(?:_\w+)?\b(?!\()")
MANY = ast.GeneratorExp | ast.ListComp | ast.SetComp
NEAREST_SQUARE = 0.0256  # [m^2] of 0.16 m
DISTANCE = "what counts is the distance, math.hypot(dx, dy)"


def _axis(node: ast.AST) -> str:
    """Return `x` or `y` if an expression is about this coordinate alone; else nothing."""
    found = set()
    for each in walk(node):
        match each:
            case ast.Attribute(attr=name) | ast.Name(id=name):
                if fits := COORDINATE.fullmatch(name.lower()):
                    found.add(fits[1])
            case ast.Subscript(slice=ast.Constant(value=0 | 1 as index)):
                found.add("y" if index == 1 else "x")
    return found.pop() if len(found) == 1 else ""


def _size(node: ast.AST, signed: bool = False) -> str:
    """Return the coordinate of which an expression is the size, or (`signed`) the difference with its sign."""
    match node:
        case ast.Call(func=function, args=[inside]) if last_name(function) in SIZES:
            return "" if signed else _axis(inside)
        case ast.Name(id=name) if signed and SIGNED.fullmatch(name.lower()):
            return _axis(node)
        case ast.BinOp(op=ast.Sub()) if signed and isinstance(node.left, ast.Attribute | ast.Subscript):
            return _axis(node)
    return ""


def _compared(node: ast.AST, signed: bool = False) -> tuple[str, bool]:
    """Return the coordinate that a comparison is about, and whether the comparison holds for a large difference."""
    match node:
        case ast.UnaryOp(op=ast.Not(), operand=inside):
            axis, far = _compared(inside, signed)
            return axis, not far
        case ast.Compare(left=left, ops=[ast.Gt() | ast.GtE() | ast.Lt() | ast.LtE() as how], comparators=[right]):
            greater = isinstance(how, ast.Gt | ast.GtE)
            if axis := _size(left, signed):
                return axis, greater
            return _size(right, signed), not greater
    return "", False


def _conditions(tree: ast.AST) -> dict[str, ast.expr]:
    """Return what names of conditions hold, such as `x_there = abs(dx) < NEAR`."""
    return {
        target.id: value
        for target, value in assigned(tree)
        if isinstance(target, ast.Name) and isinstance(value, ast.Compare | ast.UnaryOp)
    }


@suspicion_of(About.SQUARED)
def squares(tree: ast.Module) -> Words:
    """Find `distance ** 2 < 0.15`, or `dx * dx + dy * dy < 0.15`: the square of 0.39 m is that small, too."""
    if not called(tree) & {"succeed"}:
        return
    known = named_numbers(tree)
    squared = {unparse(target) for target, value in assigned(tree) if _is_square(value)}
    for node in walk(tree):
        match node:
            case ast.Compare(left=left, ops=[ast.Gt() | ast.GtE() | ast.Lt() | ast.LtE()], comparators=[limit]):
                pass
            case _:
                continue
        value = number(limit, known)
        if value is not None and NEAREST_SQUARE < value < 1 and (_is_square(left) or unparse(left) in squared):
            yield (
                node,
                f"`{unparse(node)[:80]}` compares a square with a distance: the square of {value**0.5:.2f} m is "
                f"{value:g}, so the robot counts as there {value**0.5:.2f} m away: square the limit, too",
            )


def _broken_off(loop: ast.While) -> bool:
    return any(isinstance(each, ast.Break) for part in loop.body for each in walk(part))


@suspicion_of(About.ONE_AXIS, ast.FunctionDef)
def one_axis_is_enough(function: ast.FunctionDef) -> Words:
    """Find a place that counts as reached, or a loop to it that ends, as soon as x or y alone is near."""
    held = _conditions(function)
    looped = {id(each) for one in walk(function) if isinstance(one, MANY) for each in walk(one)}
    for node in walk(function):
        match node:
            case _ if id(node) in looped:
                continue  # it compares with many places
            case ast.BoolOp(op=how, values=values):
                parts = [held.get(each.id, each) if isinstance(each, ast.Name) else each for each in values]
                found = [pair for each in parts if (pair := _compared(each))[0]]
                fits = len(found) == 2 and {far for _, far in found} == {isinstance(how, ast.And)}
                axes = {axis for axis, _ in found}
                ends = isinstance(how, ast.And)
            case ast.Compare(left=ast.Call(func=ast.Name(id="min"), args=[one, other]), ops=[how]):
                axes = {_size(one), _size(other)} - {""}
                fits, ends = True, isinstance(how, ast.Gt | ast.GtE)
            case _:
                continue
        if fits and len(axes) == 2:
            yield (
                node,
                f"`{unparse(node)[:90]}` is {'false' if ends else 'true'} as soon as x or y alone is near: {DISTANCE}",
            )


@suspicion_of(About.ONE_AXIS)
def one_axis_is_asked(tree: ast.AST) -> Words:
    """Find a loop that drives until one coordinate fits, where no condition asks for the other one or a distance."""
    if not called(tree) & {"succeed"}:
        return  # it executes no goals
    for function in functions(tree):
        for loop in nodes_of(function, ast.While):
            if isinstance(loop.test, ast.BoolOp):
                found = [each for each in loop.test.values if _compared(each)[0]]
            else:
                found = [loop.test] if _compared(loop.test)[0] else []
            left = _broken_off(loop)
            if len(found) == 1 and _compared(found[0])[1] and not left:
                other = "y" if _compared(found[0])[0] == "x" else "x"
                yield (
                    loop,
                    f"`{unparse(found[0])[:90]}` asks for one coordinate only, and {other} may be far off: {DISTANCE}",
                )


@suspicion_of(About.ONE_AXIS)
def signs_are_kept(tree: ast.AST) -> Words:
    """Find differences of coordinates that are compared with their signs: each negative one is small enough."""
    if not called(tree) & {"succeed"}:
        return
    for node in nodes_of(tree, ast.BoolOp):
        found = [pair for each in node.values if (pair := _compared(each, signed=True))[0]]
        if len(found) == 2 and len({axis for axis, _ in found}) == 2 and len({far for _, far in found}) == 1:
            yield (
                node,
                f"`{unparse(node)[:90]}` compares differences with their signs, and every negative one is small "
                f"enough, however far the robot is: {DISTANCE}",
            )


@suspicion_of(About.INVERTED)
def inverted_loops(tree: ast.AST) -> Words:
    """Find a loop that drives as long as the robot is near: it is over before it begins."""
    if not called(tree) & {"succeed"}:
        return
    for loop in nodes_of(tree, ast.While):
        left = _broken_off(loop)
        for node in loop.test.values if isinstance(loop.test, ast.BoolOp) else [loop.test]:
            match node:
                case ast.Compare(
                    left=distance,
                    ops=[ast.Lt() | ast.LtE()],
                    comparators=[ast.Name() | ast.Attribute() | ast.Constant()],
                ) if (
                    LENGTH.search(unparse(distance))
                    and "driven" not in unparse(distance)
                    and "publish" in called(loop)
                    and not left
                ):
                    yield (
                        loop,
                        f"`while {unparse(node)[:80]}` goes on while the robot is near, and is over at once where "
                        "it is far: > is asked for",
                    )


def _is_square(node: ast.AST) -> bool:
    """Return whether an expression is a square, or a sum of squares."""
    match node:
        case ast.BinOp(op=ast.Pow(), right=ast.Constant(value=2)):
            return True
        case ast.BinOp(left=left, op=ast.Mult(), right=right):
            return unparse(left) == unparse(right)
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            return _is_square(left) and _is_square(right)
    return False
