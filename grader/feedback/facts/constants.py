"""Numbers that have a name in a Python file: `PERIOD = 0.1`, `self.speed = 0.5`, `60 * 1000`."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Mapping
from math import ceil, floor, log

from gz_course.grader.feedback.facts.syntax import kept, unparse, walk

Number = int | float
OPERATIONS = {
    ast.Add: lambda a, b: a + b,
    ast.Sub: lambda a, b: a - b,
    ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a / b,
    ast.FloorDiv: lambda a, b: a // b,
}
ROUNDINGS: dict[str, Callable[[Number], Number]] = {
    "int": int,
    "float": float,
    "round": round,
    **{f"{owner}{name}": each for owner in ("", "math.", "np.") for name, each in (("ceil", ceil), ("floor", floor))},
}
LOGARITHMS = ("log", "math.log", "np.log", "numpy.log")
LARGEST = 1e18  # no product of names is computed beyond


@kept
def named_numbers(tree: ast.AST) -> dict[str, Number]:
    """Return the value of each name and attribute that is assigned one number, always the same, and nothing else."""
    found: dict[str, Number] = {}
    others: set[str] = set()
    for node in walk(tree):
        if isinstance(node, ast.Assign):
            for target, given in _pairs(node):
                value, name = number(given, found), unparse(target)
                if value is None or found.get(name, value) != value:
                    others.add(name)
                else:
                    found[name] = value
        elif isinstance(node, ast.AugAssign | ast.AnnAssign | ast.For | ast.NamedExpr):
            value = number(node.value, found) if isinstance(node, ast.AnnAssign) and node.value is not None else None
            if value is None:
                others.add(unparse(node.target))
            else:
                found[unparse(node.target)] = value
        elif isinstance(node, ast.arg):
            others.add(node.arg)
    return {name: value for name, value in found.items() if name not in others}


def _pairs(node: ast.Assign) -> Iterator[tuple[ast.expr, ast.expr]]:
    """Yield the targets of an assignment with their values, those of `width, height = 100, 80` one by one."""
    for target in node.targets:
        if isinstance(target, ast.Tuple) and isinstance(node.value, ast.Tuple):
            yield from zip(target.elts, node.value.elts, strict=False)
        else:
            parts = target.elts if isinstance(target, ast.Tuple) else [target]
            yield from ((part, node.value) for part in parts)


def number(node: ast.AST | None, names: Mapping[str, Number]) -> Number | None:
    """Return the value of an expression of numbers and of `names`; None if it is another one.

    A constant of a class is found by its bare name too: `self.PERIOD` is `PERIOD`.
    """
    match node:
        case ast.Constant(value=value) if isinstance(value, int | float) and not isinstance(value, bool):
            return value if abs(value) <= LARGEST else None
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            inner = number(operand, names)
            return None if inner is None else -inner
        case ast.BinOp(left=left, op=op, right=right) if type(op) in OPERATIONS:
            a, b = number(left, names), number(right, names)
            if a is None or b is None or (isinstance(op, ast.Div | ast.FloorDiv) and b == 0):
                return None
            result: Number = OPERATIONS[type(op)](a, b)
            return result if abs(result) <= LARGEST else None
        case ast.BinOp(left=ast.Constant(value=10), op=ast.Pow(), right=ast.Constant(value=int(power))) if power <= 18:
            return 10**power if power >= 0 else 10.0**power
        case ast.Call(func=func, args=[inner_node], keywords=[]) if unparse(func) in ROUNDINGS:
            value = number(inner_node, names)
            return None if value is None else ROUNDINGS[unparse(func)](value)
        case ast.Call(func=func, args=[inner_node], keywords=[]) if unparse(func) in LOGARITHMS:
            value = number(inner_node, names)
            return None if value is None or value <= 0 else log(value)
        case ast.Name() | ast.Attribute():
            name = unparse(node)
            return names.get(name, names.get(name.rpartition(".")[2]) if name.count(".") == 1 else None)
    return None
