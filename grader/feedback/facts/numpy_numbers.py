"""Numbers of NumPy in messages: one from an array of float32 is no float of Python; used by `whole_numbers.py`.

Source: rclpy's conversion of messages, which takes Python's float; np.float64 is a subclass of it, np.float32 is not.
Fields that are arrays of float32 are objects of the class array.array, which NumPy takes over as they are.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import Any

from gz_course.grader.feedback.facts.syntax import functions, unparse, walk
from gz_course.grader.feedback.slips.language.sequences import assigned

FLOAT32 = frozenset({"ranges", "intensities"})  # fields that are arrays of float32
VALUES = frozenset({"data", "x", "y", "z", "w", "range"})  # floating-point fields
AS_PYTHON = frozenset({"float", "int", "item", "tolist", "str", "len", "list"})
OF_AN_ARRAY = frozenset({
    "min", "max", "nanmin", "nanmax", "mean", "nanmean", "median", "sum", "sort", "partition", "clip",
})  # fmt: skip
NUMPY = ("np", "numpy")


def numpy_numbers(tree: ast.Module) -> Iterator[dict[str, Any]]:
    """Find fields of messages to which a number from an array of float32 is assigned."""
    for function in functions(tree):
        values = assigned(function)
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
