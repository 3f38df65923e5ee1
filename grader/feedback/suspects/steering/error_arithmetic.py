"""Suspects in the arithmetic of an error that a robot steers by: whole metres, and a number divided by the error."""

from __future__ import annotations

import ast
import re

from gz_course.grader.feedback.facts.syntax import Words, last_name, set_to, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

ROUNDS = frozenset({"int", "round", "floor", "ceil", "trunc", "rint"})
ERROR = re.compile(r"(^|[._])(e|err|error|diff|difference|deviation|offset)\w*$", re.IGNORECASE)


@suspicion_of(About.WHOLE_METRES)
def whole_metres(tree: ast.Module) -> Words:
    """Find a difference of distances that is rounded to whole metres."""
    if not _steers(tree):
        return
    known = set_to(tree)
    for node in walk(tree):
        match node:
            case ast.Call(args=[given], keywords=[]) if last_name(node.func) in ROUNDS:
                values = known.get(unparse(given), [given])
                if all(_is_difference(each) for each in values):
                    yield (
                        node,
                        f"{unparse(node)[:60]} is a whole number of metres: an error below 1 m, or 0.5 m, becomes "
                        "0; leave it as it is",
                    )


@suspicion_of(About.DIVIDED)
def divided(tree: ast.Module) -> Words:
    """Find a gain that is divided by the error instead of multiplied with it."""
    if not _steers(tree):
        return
    known = set_to(tree)
    for node in walk(tree):
        match node:
            case ast.BinOp(op=ast.Div(), left=gain, right=error) if _is_gain(gain):
                values = known.get(unparse(error), [])
                if ERROR.search(unparse(error)) and values and all(_is_difference(each) for each in values):
                    yield (
                        node,
                        f"{unparse(node)[:60]} divides by the error: the smaller the error is, the more the robot "
                        "turns; multiply the gain by it",
                    )


def _is_gain(node: ast.expr) -> bool:
    match node:
        case ast.Constant(value=int() | float()):
            return True
        case ast.Name() | ast.Attribute():
            return bool(re.search(r"gain|^k|_k|\bk", unparse(node), re.IGNORECASE))
    return False


def _is_difference(value: ast.expr) -> bool:
    match value:
        case ast.BinOp(op=ast.Sub(), left=left, right=right):
            return not any(isinstance(each, ast.Constant) for each in (left, right)) and "stamp" not in unparse(value)
    return False


def _steers(tree: ast.Module) -> bool:
    text = unparse(tree)
    return "angular.z" in text and ".ranges" in text
