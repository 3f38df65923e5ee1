"""Pairs of sums of cosines and sines that turn no point: a sign is wrong, one is changed before the other is made.

Source: https://en.wikipedia.org/wiki/Rotation_matrix (in two dimensions).
"""

from __future__ import annotations

import ast
import math
from collections.abc import Iterator, Mapping

from gz_course.grader.feedback.facts.syntax import (
    Place,
    assigned,
    children,
    functions,
    last_name,
    nodes_of,
    unparse,
    walk,
)
from gz_course.grader.feedback.slips import slip

SOME = 0.7  # [rad] at which a pair is tried
APART = 3  # lines between the two
Row = dict[str, float]  # by factor, what it is multiplied with


Pair = tuple[tuple[ast.BinOp, Row], tuple[ast.BinOp, Row]]


def pairs(tree: ast.AST) -> Iterator[tuple[ast.FunctionDef, Pair]]:
    """Yield two sums near each other of cosines and sines of one angle, times the same two factors."""
    for function in functions(tree):
        waves = {
            unparse(target): value
            for target, value in assigned(function)
            if isinstance(value, ast.Call) and last_name(value.func) in ("cos", "sin")
        }
        parts = {id(each) for node in walk(function) if _is_sum(node) for each in children(node)}
        sums = sorted(
            (node for node in nodes_of(function, ast.BinOp) if id(node) not in parts),
            key=lambda node: (node.lineno, node.col_offset, -(node.end_col_offset or 0)),
        )
        rows = [(node, *found) for node in sums if (found := _row(node, waves)) is not None]
        for (first, angle, row), (second, other, below) in zip(rows[::2], rows[1::2], strict=False):
            if angle != other or set(row) != set(below) or second.lineno - first.lineno > APART:
                continue
            yield function, ((first, row), (second, below))


@slip
def no_rotation(tree: ast.AST) -> Iterator[Place]:
    """Find `x = a * cos(h) - b * sin(h)` with `y = a * cos(h) + b * sin(h)`."""
    for _, ((first, row), (second, below)) in pairs(tree):
        (a, b), (c, d) = row.values(), (below[name] for name in row)
        if abs(a * d - b * c) < 1e-6:
            continue  # the same coordinate twice
        if max(abs(a * a + b * b - 1), abs(c * c + d * d - 1), abs(a * c + b * d)) > 1e-6:
            one, two = row
            yield (
                second.lineno,
                f"{unparse(first)[:50]} and {unparse(second)[:50]} do not turn a point: it is {one} * cos - {two} * "
                f"sin for x and {one} * sin + {two} * cos for y, if {one} is ahead and {two} to the left",
            )


@slip
def changed_between(tree: ast.AST) -> Iterator[Place]:
    """Find `x = x * c - y * s` with `y = x * s + y * c` after it, which reads the x that has changed."""
    for function, ((first, row), (second, _)) in pairs(tree):
        made = {id(each.value): unparse(each.targets[0]) for each in nodes_of(function, ast.Assign)}
        changed, other = made.get(id(first), ""), made.get(id(second), "")
        if changed in row and other in row and changed != other:
            yield (
                second.lineno,
                f"{other} = {unparse(second)[:50]} reads {changed}, which line {first.lineno} has changed: the "
                f"old one belongs here; assign both at once, {changed}, {other} = ..., ...",
            )


def _is_sum(node: ast.AST) -> bool:
    return isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub)


def _row(node: ast.BinOp, waves: Mapping[str, ast.expr]) -> tuple[str, Row] | None:
    """Return the angle and the factors of cosine and sine in a sum of two such products; None for anything else."""
    found: list[tuple[str, str, float]] = []
    for term, sign in _terms(node, 1.0):
        if isinstance(term, ast.BinOp) and isinstance(term.op, ast.Mult):
            for wave, factor in ((term.left, term.right), (term.right, term.left)):
                call = waves.get(unparse(wave), wave)
                if isinstance(call, ast.Call) and last_name(call.func) in ("cos", "sin") and len(call.args) == 1:
                    size = getattr(math, last_name(call.func))(SOME)
                    found.append((unparse(call.args[0]), unparse(factor), sign * size))
                    break
    if len(found) != 2 or found[0][0] != found[1][0] or found[0][1] == found[1][1]:
        return None
    return found[0][0], {factor: size for _, factor, size in found}


def _terms(node: ast.expr, sign: float) -> Iterator[tuple[ast.expr, float]]:
    match node:
        case ast.BinOp(left=left, op=ast.Add() | ast.Sub() as op, right=right):
            yield from _terms(left, sign)
            yield from _terms(right, sign if isinstance(op, ast.Add) else -sign)
        case ast.UnaryOp(op=ast.USub(), operand=inner):
            yield from _terms(inner, -sign)
        case ast.BinOp(left=ast.UnaryOp(op=ast.USub(), operand=inner), op=ast.Mult(), right=right):
            yield ast.BinOp(left=inner, op=ast.Mult(), right=right), -sign
        case _:
            yield node, sign
