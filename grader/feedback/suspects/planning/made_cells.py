"""Suspects in numbers of cells that are made of x and of y: which is the row, and which stands first in an array."""

from __future__ import annotations

import ast
import re

from gz_course.grader.feedback.facts.syntax import Words, assigned, functions, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About
from gz_course.grader.feedback.suspects.planning.own_places import CORNER_X, CORNER_Y

OF_X, OF_Y = re.compile(r"(?:\b|_)[a-z]?x\b"), re.compile(r"(?:\b|_)[a-z]?y\b")
ROWS_FIRST = re.compile(r"\((?:\w+\.)*(?:height|h|rows|n_?rows), (?:\w+\.)*(?:width|w|cols|columns)\)", re.IGNORECASE)
COLUMNS_FIRST = re.compile(r"\((?:\w+\.)*(?:width|w|cols|columns), (?:\w+\.)*(?:height|h|rows)\)", re.IGNORECASE)


@suspicion_of(About.CELL)
def exchanged(tree: ast.AST) -> Words:
    """Find `x0 + (j + 0.5) * size`, where j was made of y, and `grid[i, j]`, where i was, of an array of rows."""
    text = unparse(tree)
    rows_first = bool(ROWS_FIRST.search(text)) and not COLUMNS_FIRST.search(text)
    for function in functions(tree):
        kinds = _kinds(function)
        for node in walk(function) if len(set(kinds.values())) > 1 else ():
            match node:
                case ast.BinOp(left=corner, op=ast.Add(), right=ast.BinOp(op=ast.Mult()) as rest):
                    of = "x" if CORNER_X.search(unparse(corner)) else "y"
                    known = of == "x" or CORNER_Y.search(unparse(corner))
                    made = {kinds[name] for name in _names(rest) if name in kinds}
                    if known and len(made) == 1 and made != {of}:
                        yield (
                            node,
                            f"{unparse(node)[:60]} makes {of} of a number of cells that was made of {made.pop()}",
                        )
                case ast.Subscript(slice=ast.Tuple(elts=[first, second])) if rows_first:
                    made = {kinds[name] for name in _names(first) if name in kinds}
                    other = {kinds[name] for name in _names(second) if name in kinds}
                    if made == {"x"} and other == {"y"}:
                        yield (
                            node,
                            f"{unparse(node)[:60]} has the number of cells along x first, but the array has its "
                            "rows first, which lie along y: the index is [row, column]",
                        )


def _kinds(function: ast.FunctionDef) -> dict[str, str]:
    """Return of which coordinate each number of cells of a function is made, by its name."""
    found: dict[str, str] = {}
    others: set[str] = set()
    for target, value in assigned(function):
        name, text = unparse(target), unparse(value)
        kind = found.get(text, "")
        if any(isinstance(each, ast.BinOp) and isinstance(each.op, ast.Div | ast.FloorDiv) for each in walk(value)):
            x, y = bool(OF_X.search(text)), bool(OF_Y.search(text))
            kind = "x" if x and not y else "y" if y and not x else ""
        if not kind or found.get(name, kind) != kind:
            others.add(name)
        found[name] = kind
    return {name: kind for name, kind in found.items() if name not in others}


def _names(node: ast.AST) -> set[str]:
    return {each.id for each in nodes_of(node, ast.Name)}
