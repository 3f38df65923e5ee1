"""Suspects in places and cells: arguments in the other order, the corner minus the point, x made of a row."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Words, assigned, calls, functions, last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

OF_X, OF_Y = re.compile(r"(?:\b|_)[a-z]?x\b"), re.compile(r"(?:\b|_)[a-z]?y\b")
ROWS_FIRST = re.compile(r"\((?:\w+\.)*(?:height|h|rows|n_?rows), (?:\w+\.)*(?:width|w|cols|columns)\)", re.IGNORECASE)
COLUMNS_FIRST = re.compile(r"\((?:\w+\.)*(?:width|w|cols|columns), (?:\w+\.)*(?:height|h|rows)\)", re.IGNORECASE)
CORNER_X = re.compile(
    r"\b(?:left|ox|x0|min_?x|x_?min|origin_?x|x_?origin|corner_?x|origin\.position\.x)\b", re.IGNORECASE
)
CORNER_Y = re.compile(
    r"\b(?:bottom|oy|y0|min_?y|y_?min|origin_?y|y_?origin|corner_?y|origin\.position\.y)\b", re.IGNORECASE
)
ROW, COLUMN = re.compile(r"\b(?:rows?|r)\b"), re.compile(r"\b(?:columns?|cols?|c)\b")
X, Y = re.compile(r"(?:^|[._])[a-z]?x$"), re.compile(r"(?:^|[._])[a-z]?y$")
ROWS = re.compile(r"(?:^|[._])(?:row|r|cy|gy|iy|my|y|j)$")
HEIGHTS = re.compile(r"(?:^|[._])(?:height|h|rows|n_?rows|grid_height|map_height)$", re.IGNORECASE)
PAIRS = ((X, Y), (re.compile(r"^(?:row|r|cy|j)$"), re.compile(r"^(?:col|column|c|cx|i)$")))


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


@suspicion_of(About.CELL)
def corner_added(tree: ast.AST) -> Words:
    """Find `(x + origin_x) / resolution` where origin_x is sent as the origin of the map: it must be subtracted."""
    sent = {
        last_name(value) for target, value in assigned(tree) if re.search(r"origin\.position\.[xy]$", unparse(target))
    } - {""}
    for node in walk(tree):
        match node:
            case ast.BinOp(left=ast.BinOp(left=one, op=ast.Add(), right=other), op=ast.Div() | ast.FloorDiv()):
                for point, corner in ((one, other), (other, one)):
                    if last_name(corner) in sent and last_name(point) not in sent:
                        yield (
                            node,
                            f"{unparse(node)[:60]} adds the corner of the map, {unparse(corner)}: a cell is "
                            "counted from the corner, so subtract it",
                        )


def _part(node: ast.expr) -> tuple[str, str]:
    """Return the index of a part, and the whole: ("1", "pose") of `pose[1]`."""
    if isinstance(node, ast.Subscript):
        return unparse(node.slice), unparse(node.value)
    return "", ""


@suspicion_of(About.STRIDE, ast.BinOp)
def other_stride(node: ast.BinOp) -> Words:
    """Find `row * height + column`, by which cells of different rows share a place."""
    match node:
        case ast.BinOp(
            left=ast.BinOp(left=one, op=ast.Mult(), right=other), op=ast.Add(), right=ast.Name() | ast.Attribute()
        ):
            names = (unparse(one), unparse(other)), (unparse(other), unparse(one))
            for row, length in names:
                if ROWS.search(row) and HEIGHTS.search(length):
                    yield (
                        f"{unparse(node)[:60]} multiplies the row by the number of rows: a row is width cells "
                        f"long, so the place is {row} * width + column"
                    )


@suspicion_of(About.POSE)
def unpacked_otherwise(tree: ast.AST) -> Words:
    """Find `x, yaw, y = self.pose` where `self.pose = (p.x, p.y, heading)`."""
    kept: dict[str, set[tuple[str, ...]]] = {}
    for owner, value in assigned_wholes(tree):
        kept.setdefault(owner, set()).add(tuple(last_name(each) for each in value.elts))
    for node in nodes_of(tree, ast.Assign):
        target, orders = node.targets[0], kept.get(last_name(node.value), set())
        if not isinstance(target, ast.Tuple) or len(orders) != 1:
            continue
        (order,) = orders
        names = [last_name(each) for each in target.elts]
        if len(names) == len(order) and any(
            name in ("x", "y") and name in order and order[place] != name for place, name in enumerate(names)
        ):
            yield (
                node,
                f"{unparse(node)} takes the parts in another order than that in which they are kept: "
                f"{', '.join(each or '...' for each in order)}",
            )


def assigned_wholes(tree: ast.AST) -> Iterator[tuple[str, ast.Tuple]]:
    """Yield the name of each attribute to which a tuple is assigned, and the tuple."""
    for node in nodes_of(tree, ast.Assign):
        if isinstance(node.value, ast.Tuple):
            yield from ((each.attr, node.value) for each in node.targets if isinstance(each, ast.Attribute))


@suspicion_of(About.CELL)
def other_order(tree: ast.AST) -> Words:
    """Find `self.index(pose[1], pose[0])` and `self.index(y, x)` of a function that takes x first."""
    own = {each.name: [one.arg for one in each.args.args if one.arg != "self"] for each in functions(tree)}
    for call, name in calls(tree):
        takes = own.get(name, [])
        for place in range(min(len(takes), len(call.args)) - 1):
            first, second = call.args[place], call.args[place + 1]
            named = X.search(takes[place]) and Y.search(takes[place + 1])
            wrong = bool(named) and _part(first) == ("1", _part(second)[1]) and _part(second)[0] == "0"
            for one, other in PAIRS:
                if one.search(takes[place]) and other.search(takes[place + 1]):
                    texts = unparse(first), unparse(second)
                    wrong = wrong or bool(other.search(texts[0]) and one.search(texts[1]))
            if wrong:
                yield (
                    call,
                    f"{unparse(call)[:60]} gives {name} its arguments in the other order: it takes "
                    f"({takes[place]}, {takes[place + 1]})",
                )


@suspicion_of(About.CELL, ast.BinOp)
def corner_minus_point(node: ast.BinOp) -> Words:
    """Find `(BOTTOM - y) / RESOLUTION`, which is negative for every point in the map."""
    match node:
        case ast.BinOp(left=ast.BinOp(left=point, op=ast.Div() | ast.FloorDiv()), op=ast.Sub(), right=corner):
            text, other = unparse(corner), unparse(point)
            if (CORNER_X.search(text) and X.search(other)) or (CORNER_Y.search(text) and Y.search(other)):
                yield (
                    f"{unparse(node)[:60]} subtracts the corner [m] from a number of cells: subtract first, "
                    f"then divide, ({other} - {text}) / resolution"
                )
        case ast.BinOp(left=ast.BinOp(left=corner, op=ast.Sub(), right=point), op=ast.Div() | ast.FloorDiv()):
            text, other = unparse(corner), unparse(point)
            x, y = bool(CORNER_X.search(text)), bool(CORNER_Y.search(text))
            if (x and X.search(other)) or (y and Y.search(other)):
                yield (
                    f"{unparse(node)[:60]} is negative for every point in the map: it is the point minus the "
                    f"corner, ({other} - {text})"
                )


@suspicion_of(About.CELL, ast.BinOp)
def axes_of_cells(node: ast.BinOp) -> Words:
    """Find `x0 + (row + 0.5) * resolution`: x grows with the column."""
    if not isinstance(node.op, ast.Add):
        return
    corner, rest = unparse(node.left), unparse(node.right)
    if not isinstance(node.right, ast.BinOp) or not isinstance(node.right.op, ast.Mult):
        return
    for pattern, wrong, right, axis in (
        (CORNER_X, ROW, COLUMN, "x grows with the column, y with the row"),
        (CORNER_Y, COLUMN, ROW, "y grows with the row, x with the column"),
    ):
        if pattern.search(corner) and wrong.search(rest) and not right.search(rest):
            yield f"{unparse(node)[:60]} exchanges rows and columns: {axis}"
