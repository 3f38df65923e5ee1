"""A sum of floats that is compared with == and never becomes exactly that number.

The sum is computed as the program does it, so what is reported is proven: 0.25 added four times is 1.0, 0.1 added ten
times is not.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.constants import Number, named_numbers, number
from gz_course.grader.feedback.facts.syntax import Place, nodes_of, unparse, walk
from gz_course.grader.feedback.slips import slip

MOST_STEPS = 100_000  # added at most; no timer of a run fires that often


@slip
def compared_exactly(tree: ast.AST) -> Iterator[Place]:
    """Find `elapsed == 1.0` where elapsed is only set to a number and to itself plus a step."""
    known = named_numbers(tree)
    steps = _steps(tree, known)
    for node in nodes_of(tree, ast.Compare):
        if len(node.ops) != 1 or not isinstance(node.ops[0], ast.Eq | ast.NotEq):
            continue
        for one, other in ((node.left, node.comparators[0]), (node.comparators[0], node.left)):
            limit = number(other, known)
            if limit is not None and (why := _never(one, limit, steps, known)):
                yield node.lineno, f"{unparse(node)[:60]}: {why}"


def _never(node: ast.expr, limit: Number, steps: dict[str, tuple[Number, Number]], known: dict[str, Number]) -> str:
    """Return why a sum, a multiple of it or its remainder is never exactly a number; empty if it may be."""
    match node:
        case ast.Name() | ast.Attribute() if (name := unparse(node)) in steps:
            start, step = steps[name]
            around = _around(start, step, limit)
            said = f"{name} is never exactly {limit:g}: adding {step:g} again and again gives"
        case ast.BinOp(left=ast.Name() | ast.Attribute() as of, op=ast.Mult(), right=right) if (
            name := unparse(of)
        ) in steps and (factor := number(right, known)):
            start, step = steps[name]
            around = _around_multiple(start, step, factor, limit)
            said = f"{unparse(node)} is never exactly {limit:g}: it is"
        case ast.BinOp(left=ast.Name() | ast.Attribute() as of, op=ast.Mod(), right=right) if (
            name := unparse(of)
        ) in steps and (whole := number(right, known)):
            start, step = steps[name]
            around = _around(start, step, limit + whole)  # the first time that it is reached but for the start
            said = f"{name} is not exactly {limit + whole:g}: adding {step:g} again and again gives"
        case _:
            return ""
    if around is None:
        return ""
    way = (
        "a whole number can be compared exactly: count the ticks"
        if isinstance(node, ast.BinOp)
        else (f"compare with {'>=' if step > 0 else '<='}, or count in whole numbers")
    )
    return f"{said} {around[0]!r}, then {around[1]!r}, because a float is rounded; {way}"


def _steps(tree: ast.AST, known: dict[str, Number]) -> dict[str, tuple[Number, Number]]:
    """Return start and step of each name that is only ever set to one number, and to itself plus one number."""
    starts: dict[str, set[Number | None]] = {}
    added: dict[str, set[Number | None]] = {}
    for node in walk(tree):
        if isinstance(node, ast.Assign):
            for target in node.targets:
                name = unparse(target)
                match node.value:
                    case ast.BinOp(left=left, op=op, right=right) if unparse(left) == name:
                        added.setdefault(name, set()).add(_change(op, number(right, known)))
                    case value:
                        starts.setdefault(name, set()).add(number(value, known))
        elif isinstance(node, ast.AugAssign):
            change = _change(node.op, number(node.value, known))
            added.setdefault(unparse(node.target), set()).add(change)
        elif isinstance(node, ast.For | ast.AnnAssign | ast.NamedExpr):
            given = node.value if isinstance(node, ast.AnnAssign) else None
            starts.setdefault(unparse(node.target), set()).add(number(given, known))
    found: dict[str, tuple[Number, Number]] = {}
    for name, steps in added.items():
        begins = starts.get(name, set())
        if len(steps) == 1 and len(begins) == 1:
            (step,), (start,) = steps, begins
            if step and start is not None:
                found[name] = start, step
    return found


def _change(op: ast.operator, step: Number | None) -> Number | None:
    """Return what a sum or difference adds; None if it is unknown, or another operation."""
    sign = {ast.Add: 1, ast.Sub: -1}.get(type(op))
    return None if step is None or sign is None else sign * step


def _around(start: Number, step: Number, limit: Number) -> tuple[Number, Number] | None:
    """Return the sums on both sides of a limit; None if a sum meets it, or if it is not on the way."""
    if (limit - start) / step < 0 or (limit - start) / step > MOST_STEPS:
        return None
    value = start
    while value != limit:
        if (value + step > limit) if step > 0 else (value + step < limit):
            return value, value + step
        value += step
    return None


def _around_multiple(start: Number, step: Number, factor: Number, limit: Number) -> tuple[Number, Number] | None:
    """Return the multiples of the sums on both sides of a limit; None if one meets it, or if it is not on the way."""
    nearest = round((limit / factor - start) / step)
    if not 0 < nearest <= MOST_STEPS or not isinstance(start + step, int):
        return None
    values = [(start + count * step) * factor for count in range(nearest - 1, nearest + 2)]
    if limit in values or not min(values) < limit < max(values):
        return None
    low, high = max(value for value in values if value < limit), min(value for value in values if value > limit)
    return (low, high) if values[0] < values[-1] else (high, low)
