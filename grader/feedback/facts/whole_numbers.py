"""The places where a file assigns what is no float of Python to a floating-point field.

Source: rclpy's conversion of messages, which takes Python's float; np.float64 is a subclass of it, np.float32 is not.
Fields that are arrays of float32 are objects of the class array.array, which NumPy takes over as they are.

rclpy does not convert the value, and without ROS_PYTHON_CHECK_FIELDS=1 it does not complain either: `twist.linear.x =
1` is sent as 0, and so is "0.5". Kinds of submissions that are Python record these places as facts of a run; the
diagnosis mentions them if a check failed (`grader/score/score.py`).
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import Any

from gz_course.grader.feedback.facts.syntax import Places, functions, places_in, unparse, walk
from gz_course.grader.feedback.slips.language.sequences import given_to_names

FLOAT32 = frozenset({"ranges", "intensities"})  # fields that are arrays of float32
VALUES = frozenset({"data", "x", "y", "z", "w", "range"})  # floating-point fields
AS_PYTHON = frozenset({"float", "int", "item", "tolist", "str", "len", "list"})
OF_AN_ARRAY = frozenset({
    "min", "max", "nanmin", "nanmax", "mean", "nanmean", "median", "sum", "sort", "partition", "clip",
})  # fmt: skip
NUMPY = ("np", "numpy")
MOST = 5  # places reported at most


def numpy_numbers(tree: ast.Module) -> Iterator[dict[str, Any]]:
    """Find fields of messages to which a number from an array of float32 is assigned."""
    for function in functions(tree):
        values = given_to_names(function)
        known: set[str] = set()
        for _ in range(len(values) + 1):  # names may be made of other names
            more = {name for name, made in values.items() if made and all(v and _float32(v, known) for v in made)}
            if more <= known:
                break
            known |= more
        for line, field, value in _sent(function):
            if _float32(value, known):
                yield {"line": line, "field": field, "value": unparse(value), "type": "np.float32"}


def _sent(function: ast.FunctionDef) -> Iterator[tuple[int, str, ast.expr]]:
    for node in walk(function):
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Attribute):
            target = node.targets[0]
            if target.attr in VALUES and not (isinstance(target.value, ast.Name) and target.value.id == "self"):
                yield node.lineno, unparse(target), node.value
        elif isinstance(node, ast.Call):
            owner = unparse(node.func).rpartition(".")[2]
            yield from ((node.lineno, f"{owner}.data", each.value) for each in node.keywords if each.arg == "data")


def _float32(node: ast.expr, known: set[str]) -> bool:
    """Return whether an expression is an array of float32, or one of its numbers."""
    match node:
        case ast.Name():
            return node.id in known
        case ast.Subscript():
            return _float32(node.value, known)
        case ast.Call(func=ast.Attribute() as function):
            name = function.attr
            if name in AS_PYTHON or name.startswith("arg") or name in ("where", "nonzero", "count_nonzero", "size"):
                return False
            kind = next((unparse(each.value) for each in node.keywords if each.arg == "dtype"), "")
            kind = kind or (unparse(node.args[1]) if name in ("array", "asarray") and len(node.args) > 1 else "")
            if kind or name == "astype":
                return "float32" in kind + "".join(map(unparse, node.args))
            if name == "float32":
                return unparse(function.value) in NUMPY
            if name in ("array", "asarray"):
                given = node.args[0] if node.args else None
                field = isinstance(given, ast.Attribute) and given.attr in FLOAT32
                return field or (given is not None and _float32(given, known))
            if name in OF_AN_ARRAY:
                owner = unparse(function.value)
                return (
                    _float32(node.args[0], known) if owner in NUMPY and node.args else _float32(function.value, known)
                )
            return False
        case ast.Call(func=ast.Name(id="min" | "max"), args=[given]):
            return _float32(given, known)
        case ast.Call(func=ast.Name(id="round"), args=[given, *_]):
            return _float32(given, known) and len(node.args) > 1
    return False


def whole_numbers(content: bytes, fields: dict[str, set[str]]) -> Places:
    """Return `line`, `field` and the `value` as written, for each such place; nothing if the file is not Python.

    `fields` is what `grader/run/message_fields.py` returns. A zero is sent correctly and is not reported.
    """
    return places_in(content, lambda tree: sorted(_places(tree, fields), key=lambda place: place["line"])[:MOST])


def _places(tree: ast.Module, fields: dict[str, set[str]]) -> Iterator[dict[str, Any]]:
    known = _constants(tree)
    # A field named `data` may belong to a message of whole numbers or texts, if the file uses one.
    others = any(isinstance(n, ast.alias) and n.name.startswith(("Int", "UInt", "Bool", "String")) for n in walk(tree))
    paths = {path for owner in fields.values() for path in owner if "." in path or (len(owner) == 1 and not others)}
    yield from numpy_numbers(tree)
    for node in walk(tree):
        if isinstance(node, ast.Assign | ast.AnnAssign):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            for target in targets:
                if isinstance(target, ast.Attribute) and node.value is not None and _whole(node.value, known):
                    written = unparse(target)
                    if any(written.endswith(f".{path}") for path in paths if "." in path or _is_message(target, path)):
                        yield {"line": node.lineno, "field": written, "value": unparse(node.value)}
        elif isinstance(node, ast.Call):
            owner = unparse(node.func).rpartition(".")[2]
            for word in node.keywords:
                if word.arg in fields.get(owner, ()) and _whole(word.value, known):
                    yield {"line": word.value.lineno, "field": f"{owner}.{word.arg}", "value": unparse(word.value)}


def _is_message(target: ast.Attribute, path: str) -> bool:
    """Return whether the owner of the field may be a message; attributes of `self` belong to the node."""
    return target.attr == path and not (isinstance(target.value, ast.Name) and target.value.id == "self")


def _constants(tree: ast.Module) -> set[str]:
    """Return the names and attributes to which only whole numbers other than zero are assigned."""
    whole: dict[str, bool] = {}
    for node in walk(tree):
        if isinstance(node, ast.Assign):
            for target in node.targets:
                name = unparse(target)
                whole[name] = whole.get(name, True) and _whole(node.value, set())
        elif isinstance(node, ast.AugAssign | ast.AnnAssign | ast.For | ast.NamedExpr):
            whole[unparse(node.target)] = False
        elif isinstance(node, ast.arg):
            whole[node.arg] = False
    return {name for name, always in whole.items() if always}


def _whole(node: ast.expr, known: set[str]) -> bool:
    """Return whether the value, or one branch of it, is certainly neither a float nor a zero."""
    match node:
        case ast.Constant(value=value):
            return (type(value) is int and value != 0) or isinstance(value, str) or value is None or value is True
        case ast.List() | ast.Tuple() | ast.Set() | ast.Dict():
            return True
        case ast.Call(func=ast.Attribute(attr="get_parameter" | "declare_parameter")):
            return True
        case ast.UnaryOp(op=ast.USub() | ast.UAdd(), operand=operand):
            return _whole(operand, known)
        case ast.BinOp(op=ast.Add() | ast.Sub() | ast.Mult(), left=left, right=right):
            return _whole(left, known) and _whole(right, known)
        case ast.IfExp(body=body, orelse=orelse):
            return _whole(body, known) or _whole(orelse, known)
        case ast.Call(func=ast.Name(id="int"), args=[_]) | ast.Call(func=ast.Name(id="round"), args=[_], keywords=[]):
            return True
        case ast.Name() | ast.Attribute():
            return unparse(node) in known
    return False
