"""Formulas for a heading that are computed here for some quaternions, and give something else."""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Callable

from gz_course.grader.feedback.facts.syntax import Words, assigned, last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

NAMED = re.compile(r"heading|yaw|theta", re.IGNORECASE)
TURNED = (1.0, -1.2, 2.1, -2.6)  # [rad] headings that are tried
DEEPEST = 8  # names behind names that are followed
FUNCTIONS: dict[str, Callable[..., float]] = {
    "asin": math.asin,
    "acos": math.acos,
    "atan": math.atan,
    "atan2": math.atan2,
    "arcsin": math.asin,
    "arccos": math.acos,
    "arctan": math.atan,
    "arctan2": math.atan2,
    "sqrt": math.sqrt,
    "pow": math.pow,
    "degrees": math.degrees,
    "radians": math.radians,
}
OPERATORS: dict[type[ast.operator], Callable[[float, float], float]] = {
    ast.Add: lambda a, b: a + b,
    ast.Sub: lambda a, b: a - b,
    ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a / b,
    ast.Pow: lambda a, b: a**b if abs(b) <= 4 else math.nan,
}
FAILS = (ValueError, ZeroDivisionError, OverflowError, TypeError)


class _Unknown(ValueError):
    """Something in a formula that is no part of a quaternion, number or known function."""


def _value(node: ast.expr, yaw: float, names: dict[str, ast.expr], depth: int = DEEPEST) -> float:
    """Return what a formula gives for a robot on flat ground that has turned by `yaw` [rad]."""
    match node:
        case ast.Constant(value=int() | float() as number):
            return float(number)
        case ast.Attribute(attr="x" | "y"):
            return 0.0
        case ast.Attribute(attr="z"):
            return math.sin(yaw / 2)
        case ast.Attribute(attr="w"):
            return math.cos(yaw / 2)
        case ast.Attribute(attr="pi"):
            return math.pi
        case ast.Name(id=name) if depth and name in names:
            return _value(names[name], yaw, names, depth - 1)
        case ast.UnaryOp(op=ast.USub(), operand=inside):
            return -_value(inside, yaw, names, depth)
        case ast.BinOp(left=left, op=operator, right=right) if type(operator) in OPERATORS:
            return OPERATORS[type(operator)](_value(left, yaw, names, depth), _value(right, yaw, names, depth))
        case ast.Call(func=function, args=given, keywords=[]) if last_name(function) in FUNCTIONS:
            return FUNCTIONS[last_name(function)](*(_value(each, yaw, names, depth) for each in given))
    raise _Unknown


@suspicion_of(About.HEADING, ast.FunctionDef)
def other_formulas(function: ast.FunctionDef) -> Words:
    """Find a heading that is computed of a quaternion, and is not the heading on flat ground."""
    names: dict[str, ast.expr] = {}
    for target, value in assigned(function):
        if isinstance(target, ast.Name):
            names[target.id] = ast.Constant(None) if target.id in names else value  # two values are unknown
    given = [(t, v) for t, v in assigned(function) if NAMED.search(last_name(t))]
    if NAMED.search(function.name):
        given += [(n.value, n.value) for n in nodes_of(function, ast.Return) if n.value is not None]
    for _, value in given:
        said = _said(value, names) if _of_a_quaternion(value, names) else ""
        if said:
            yield value, f"`{unparse(value)[:80]}` {said}"


def _of_a_quaternion(value: ast.expr, names: dict[str, ast.expr], depth: int = DEEPEST) -> bool:
    """Return whether parts of a quaternion are in a formula, an inverse function among them."""
    parts, inverse, todo, seen = set[str](), False, [value], set[str]()
    for each in todo:
        for node in walk(each):
            if isinstance(node, ast.Attribute) and node.attr in ("x", "y", "z", "w"):
                parts.add(node.attr)
            inverse |= isinstance(node, ast.Call) and last_name(node.func).startswith(("a", "arc"))
            if isinstance(node, ast.Name) and node.id in names and node.id not in seen and len(seen) < depth:
                seen.add(node.id)
                todo.append(names[node.id])
    return inverse and "w" in parts


def _said(value: ast.expr, names: dict[str, ast.expr]) -> str:
    """Return what a formula gives instead of the heading; empty if it gives the heading, half of it, or is unknown."""
    try:
        found = [_value(value, yaw, names) for yaw in TURNED]
    except FAILS:
        return ""
    for factor in (1.0, 0.5):  # half of it may be doubled elsewhere, and the sign be told by z
        if all(math.isclose(abs(one), abs(factor * yaw)) for one, yaw in zip(found, TURNED, strict=True)):
            mirrored = all(one * yaw < 0 for one, yaw in zip(found, TURNED, strict=True))
            return "has the wrong sign: the heading is 2 * atan2(z, w)" if mirrored else ""
    if all(abs(one - math.degrees(yaw)) < 1e-6 for one, yaw in zip(found, TURNED, strict=True)):
        return ""  # degrees may be meant
    if max(map(abs, found)) < 1e-9:
        return "is always 0 on flat ground, where x and y are 0: the heading is 2 * atan2(z, w)"
    return f"gives {found[0]:.2f} where a robot has turned by 1 rad to the left: the heading is 2 * atan2(z, w)"
