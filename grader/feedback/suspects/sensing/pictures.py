"""Suspects in what reads pictures: the order of their shape and of their indices, another middle than that of columns.

Source: https://numpy.org/doc/stable/reference/generated/numpy.ndarray.shape.html; OpenCV and cv_bridge give pictures
as (rows, columns, channels).
"""

from __future__ import annotations

import ast
import re

from gz_course.grader.feedback.facts.syntax import Words, assigned, called, calls, last_name, nodes_of, unparse
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

ACROSS = re.compile(r"(?:^|_|\.)(?:w|width|wide|columns|cols|ncols)$")
DOWN = re.compile(r"(?:^|_|\.)(?:h|height|high|rows|nrows)$")
COLUMN = re.compile(r"^(?:column|col|u|cx|middle|centre|center)$")
ROW = re.compile(r"^(?:row|v|line|cy)$")
COLUMNS = re.compile(r"(?:^|_|\.)(?:columns?|cols?|us?|xs?)$")
ROWS = re.compile(r"(?:^|_|\.)(?:rows?|lines?|vs?|ys?)$")
RIGHT = "the shape of a picture is (height, width, channels)"


def _arrays(tree: ast.AST) -> set[str]:
    """Return the names of pictures: what is assigned an array made of a message."""
    return {unparse(target) for target, value in assigned(tree) if called(value) & {"imgmsg_to_cv2", "reshape"}}


@suspicion_of(About.PICTURE)
def shapes(tree: ast.AST) -> Words:
    """Find a shape whose first number is taken for the width."""
    for node in nodes_of(tree, ast.Assign):
        for target in node.targets:
            value = node.value
            if isinstance(value, ast.Subscript) and isinstance(value.slice, ast.Slice) and not value.slice.step:
                value = value.value  # shape[:2]
            if isinstance(target, ast.Tuple) and len(target.elts) >= 2 and _is_shape(value):
                first, second = (unparse(each).lower() for each in target.elts[:2])
                if ACROSS.search(first) and DOWN.search(second):
                    yield node, f"{unparse(node)[:70]} takes the height for the width: {RIGHT}"
    for target, value in assigned(tree):
        if isinstance(value, ast.Subscript) and _is_shape(value.value):
            name, index = unparse(target).lower(), unparse(value.slice)
            if (index == "0" and ACROSS.search(name)) or (index == "1" and DOWN.search(name)):
                yield value, f"{name} is {unparse(value)}, but {RIGHT}"


def _is_shape(value: ast.expr) -> bool:
    return (
        isinstance(value, ast.Attribute)
        and value.attr == "shape"
        and not re.search(r"\.T\b|transpose|swapaxes", unparse(value))
    )


@suspicion_of(About.PICTURE)
def indices(tree: ast.AST) -> Words:
    """Find a picture that is asked for [column, row]."""
    arrays = _arrays(tree)
    for node in nodes_of(tree, ast.Subscript):
        if unparse(node.value) not in arrays:
            continue
        if isinstance(node.slice, ast.Tuple) and len(node.slice.elts) >= 2:
            first, second = (unparse(each).lower() for each in node.slice.elts[:2])
            if COLUMN.search(first) and ROW.search(second):
                yield node, f"{unparse(node)[:60]}: the row comes first, picture[row, column]"


@suspicion_of(About.PICTURE, ast.Assign)
def unpacked_indices(node: ast.Assign) -> Words:
    """Find `columns, rows = np.nonzero(mask)`, which returns the rows first."""
    match node:
        case ast.Assign(targets=[ast.Tuple(elts=[first, second])], value=ast.Call(args=[mask]) as call):
            pass
        case _:
            return
    if last_name(call.func) not in ("nonzero", "where") or ".T" in unparse(mask):
        return
    if COLUMNS.search(unparse(first).lower()) and ROWS.search(unparse(second).lower()):
        yield (
            f"{unparse(node)[:70]} takes the rows for the columns: an array is [row, column], so "
            f"{last_name(call.func)}() returns the rows first"
        )


@suspicion_of(About.PICTURE)
def middles(tree: ast.AST) -> Words:
    """Find the middle of the columns that is made of the rows, or of the wrong numbers of camera_info."""
    for target, value in assigned(tree):
        name, text = unparse(target), unparse(value)
        if not re.search(r"middle|centre|center|\bcx\b|_cx\b", name):
            continue
        if re.search(r"\bheight\b.* / 2|\.shape\[0\].* / 2", text) and "width" not in text:
            yield value, f"{name} is made of the height: the middle of the columns is cx = k[2]"
        found = re.fullmatch(r"\w+\.[kK]\[(\d)\]", text)
        if found and found[1] in "5" and not re.search("y|row", name):
            yield value, f"{name} is {text}, the middle row, cy: the middle of the columns is cx = k[2]"


@suspicion_of(About.DEPTH)
def means_of_depths(tree: ast.AST) -> Words:
    """Find the mean of a rectangle of a picture of depths, which a single inf makes inf."""
    arrays = _arrays(tree)
    for call, name in calls(tree):
        given = call.args[0] if call.args else getattr(call.func, "value", None)
        if name not in ("mean", "average") or not isinstance(given, ast.Subscript):
            continue
        parts = given.slice.elts if isinstance(given.slice, ast.Tuple) else [given.slice]
        if unparse(given.value) in arrays and any(isinstance(each, ast.Slice) for each in parts):
            yield (
                call,
                f"{unparse(call)[:70]} is inf as soon as one of these pixels is inf, where nothing is near enough: "
                "take the red pixels only, and leave out what is not finite",
            )


@suspicion_of(About.PICTURE)
def cropped(tree: ast.AST) -> Words:
    """Find a picture whose first columns are cut off, in a file that never adds their number again."""
    for target, value in assigned(tree):
        if not isinstance(value, ast.Subscript) or not isinstance(value.slice, ast.Tuple) or len(value.slice.elts) < 2:
            continue
        across = value.slice.elts[1]
        first = unparse(across.lower) if isinstance(across, ast.Slice) and across.lower is not None else ""
        again = re.compile(rf"(?<![\w.])(?:\+ {re.escape(first)}|{re.escape(first)} \+)(?![\w.])")
        of_picture = "imgmsg_to_cv2" in called(value) or unparse(value.value) in _arrays(tree)
        if first.isdigit() and int(first) and of_picture and not again.search(unparse(tree)):
            yield (
                value,
                f"{unparse(target)} begins at column {first} of the picture, so its column 0 is column {first}: "
                f"add {first} to each column before cx is subtracted",
            )


@suspicion_of(About.OVERFLOW)
def overflows(tree: ast.AST) -> Words:
    """Find the channel of a picture of 8 bits that is multiplied, added or subtracted as it is."""
    pictures = {
        unparse(target)
        for target, value in assigned(tree)
        if "imgmsg_to_cv2" in called(value) and not called(value) & {"astype", "int32", "float32", "array", "asarray"}
        and not re.search(r"32FC1|16UC1|depth", unparse(value))
    }  # fmt: skip
    channels = {unparse(target) for target, value in assigned(tree) if _is_channel(value, pictures)}
    for node in nodes_of(tree, ast.BinOp):
        if not isinstance(node.op, ast.Mult | ast.Add | ast.Sub):
            continue
        for side, other in ((node.left, node.right), (node.right, node.left)):
            whole = isinstance(other, ast.Constant) and type(other.value) is int
            both = unparse(other) in channels or _is_channel(other, pictures)
            if (unparse(side) in channels or _is_channel(side, pictures)) and (whole or both):
                yield (
                    node,
                    f"{unparse(node)[:60]} overflows, because a picture has numbers of 8 bits (2 * 200 is 144): "
                    "convert it first, .astype(int)",
                )
                return


def _is_channel(value: ast.expr, pictures: set[str]) -> bool:
    return isinstance(value, ast.Subscript) and unparse(value.value) in pictures
