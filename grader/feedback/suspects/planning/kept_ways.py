"""Suspects in how a robot keeps to its way: without one, across corners, too near to walls or too far off."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.constants import Number, named_numbers, number
from gz_course.grader.feedback.facts.syntax import Words, assigned, calls, functions, last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion, suspicion_of
from gz_course.grader.feedback.suspects.about import About, Suspect

WAY = re.compile(r"path|way|route|plan|frontier|goal|target", re.IGNORECASE)
FAR, FAR_CELLS = 0.8, 8  # [m], [cells] ahead on the way, from where on corners are cut
LARGE = 4  # [cells] around the robot, from where on walls that matter are left out
CELL = 0.1  # [m]
DISTANCES = ("hypot", "dist", "distance", "norm")
NOTHING = ("0", "FREE", "self.FREE")
NARROW, WIDE = 2, 5  # [cells] at most, at least


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


@suspicion
def margins(tree: ast.Module) -> Iterator[Suspect]:
    """Find by how many cells walls are widened before a way is planned."""
    if "OccupancyGrid" not in unparse(tree):
        return
    for line, code, cells in _widenings(tree):
        if 0 <= cells <= NARROW:
            yield (
                line,
                About.NARROW,
                f"{code} is {cells:g}, so ways keep {cells:g} cell{'' if cells == 1 else 's'} ({cells * CELL:.1f} m) "
                "away from walls: too little for a radius of 0.18 m and half a cell of rounding; 3 cells are enough",
            )
        elif cells >= WIDE:
            yield (
                line,
                About.WIDE,
                f"{code} is {cells:g}, so ways keep {cells:g} cells ({cells * CELL:.1f} m) away from walls on both "
                "sides, which closes doors and corners: radius and some margin are about 3 cells",
            )


@suspicion_of(About.WIDE)
def widened_unknown(tree: ast.AST) -> Words:
    """Find walls that are widened together with what is unknown, which closes every way to a frontier."""
    if "OccupancyGrid" not in unparse(tree):
        return
    for function in functions(tree):
        for node in nodes_of(function, ast.If):
            reaches = [_reach_code(each.iter) for each in nodes_of(node, ast.For)]
            if len([each for each in reaches if each]) < 2 or len(node.body) != 1:
                continue
            match node.test:
                case ast.Compare(ops=[ast.NotEq()], comparators=[free]) if unparse(free) in NOTHING:
                    yield (
                        node,
                        f"`{unparse(node.test)[:60]}` is true for unknown cells, too, and they are widened like "
                        "walls, so no free cell beside an unknown one can be reached: widen the occupied cells only",
                    )


def _widenings(tree: ast.Module) -> Iterator[tuple[int, str, Number]]:
    """Yield the line, the code and the number of cells of each loop over a square around a cell."""
    known = named_numbers(tree)
    for function in functions(tree):
        reaches = [
            (each.iter.lineno, name)
            for each in nodes_of(function, ast.For, ast.comprehension)
            if (name := _reach_code(each.iter))
        ]
        names = [each.arg for each in function.args.args if each.arg != "self"]
        for name in {name for _, name in reaches}:
            if sum(each == name for _, each in reaches) < 2:
                continue
            line = next(line for line, each in reaches if each == name)
            if name not in names:
                value = number(ast.parse(name, mode="eval").body, known)
                value = _by_cells(function, name, known) if value is None else value
                if value is not None:
                    yield _made_at(function, name) or line, name, value
                continue
            for call, called in calls(tree):
                place = names.index(name)
                if called == function.name and len(call.args) > place and _of_walls(call, known):
                    value = number(call.args[place], known)
                    if value is not None:
                        yield call.lineno, unparse(call.args[place]), value
    for call, called in calls(tree):
        for each in call.keywords:
            value = number(each.value, known)
            if called == "binary_dilation" and each.arg == "iterations" and value is not None:
                yield call.lineno, f"iterations of {called}", value


def _reach_code(of: ast.expr) -> str:
    """Return the code of r of `range(-r, r + 1)`; empty if it is another loop."""
    match of:
        case ast.Call(func=ast.Name(id="range"), args=[ast.UnaryOp(op=ast.USub(), operand=reach), _]):
            return unparse(reach) if isinstance(reach, ast.Name | ast.Attribute) else ""
    return ""


def _made_at(function: ast.FunctionDef, name: str) -> int:
    """Return the line of a function that assigns a name; 0 if it does not."""
    made = nodes_of(function, ast.Assign)
    return next((each.lineno for each in made if name in [unparse(target) for target in each.targets]), 0)


def _by_cells(function: ast.FunctionDef, name: str, known: dict[str, Number]) -> Number | None:
    """Return the number that a function assigns to a name, if a resolution whose value is not written is a cell's."""
    for target, value in assigned(function):
        if unparse(target) == name:
            text = re.sub(r"(?:\w+\.)*(?:resolution|cell_size)\b", f"{CELL}", unparse(value))
            return number(ast.parse(text, mode="eval").body, known)
    return None


def _of_walls(call: ast.Call, known: dict[str, Number]) -> bool:
    """Return whether what is widened is not what is unknown, as for the search for frontiers."""
    first = unparse(call.args[0]).lower()
    if any(known.get(unparse(each)) == -1 for each in nodes_of(call.args[0], ast.Name, ast.Attribute)):
        return False
    return "unknown" not in first and "-1" not in first and "free" not in first and last_name(call.func) != "roll"
