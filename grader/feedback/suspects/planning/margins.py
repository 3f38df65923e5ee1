"""Suspects in how far ways keep from walls: by fewer cells than the robot's radius, or by so many that doors close."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.constants import Number, named_numbers, number
from gz_course.grader.feedback.facts.syntax import Words, assigned, calls, functions, last_name, nodes_of, unparse
from gz_course.grader.feedback.suspects import suspicion, suspicion_of
from gz_course.grader.feedback.suspects.about import About, Suspect

CELL = 0.1  # [m]
NOTHING = ("0", "FREE", "self.FREE")
NARROW, WIDE = 2, 5  # [cells] at most, at least


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
            reaches = [_reach(each.iter) for each in nodes_of(node, ast.For)]
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
            if (name := _reach(each.iter))
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


def _reach(of: ast.expr) -> str:
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
