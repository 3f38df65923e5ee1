"""Suspects in conditions on the age of a message that use the old ones and drop the fresh ones (`age`)."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.lint.syntax import Suspect, assigned, calls

OLDER, YOUNGER = (ast.Gt, ast.GtE), (ast.Lt, ast.LtE)
LEAVES = ast.Return | ast.Continue
STEPS = 3  # names followed at most


def turned(tree: ast.AST) -> Iterator[Suspect]:
    """Find `if age > LIMIT:` before what uses the message, and `if age < LIMIT: return`."""
    values: dict[str, list[ast.expr]] = {}
    for target, value in assigned(tree):
        values.setdefault(ast.unparse(target), []).append(value)
    for node in ast.walk(tree):
        if not isinstance(node, ast.If):
            continue
        drops, uses = isinstance(node.body[-1], LEAVES) and not _acts(node.body), _acts(node.body)
        for test, holds in _parts(node.test, True):
            asked = _older(test, values)
            if asked is None or not (drops or uses):
                continue
            if (asked == holds) == uses:
                yield (
                    test.lineno,
                    "age",
                    f"`{ast.unparse(node.test)[:60]}` lets only old messages through, and drops the fresh ones, whose "
                    "age is nearly 0: the comparison is the wrong way round",
                )


def _parts(test: ast.expr, holds: bool) -> Iterator[tuple[ast.expr, bool]]:
    """Yield the comparisons of a condition, and whether each holds where the condition does."""
    if isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not):
        yield from _parts(test.operand, not holds)
    elif isinstance(test, ast.BoolOp):
        for each in test.values:
            yield from _parts(each, holds)
    else:
        yield test, holds


def _older(test: ast.expr, values: dict[str, list[ast.expr]]) -> bool | None:
    """Return whether a comparison asks for an old message; None if it asks for something else, or for a fresh one."""
    if not isinstance(test, ast.Compare) or len(test.ops) != 1:
        return None
    for side, older, younger in (
        (test.left, OLDER, YOUNGER),
        (test.comparators[0], YOUNGER, OLDER),
    ):
        if _is_age(side, values, STEPS) and isinstance(test.ops[0], (*older, *younger)):
            return isinstance(test.ops[0], older)
    return None


def _is_age(node: ast.expr, values: dict[str, list[ast.expr]], steps: int) -> bool:
    """Return whether an expression is the time now less that of a stamp."""
    for each in ast.walk(node):
        if isinstance(each, ast.BinOp) and isinstance(each.op, ast.Sub):
            return _reads(each.left, "now", values, steps) and _reads(each.right, "stamp", values, steps)
        if isinstance(each, ast.Name | ast.Attribute) and steps:
            given = values.get(ast.unparse(each), [])
            if len(given) == 1 and _is_age(given[0], values, steps - 1):
                return True
    return False


def _reads(node: ast.expr, name: str, values: dict[str, list[ast.expr]], steps: int) -> bool:
    """Return whether an expression has an attribute of that name, also by the names in it."""
    parts = [each for each in ast.walk(node) if isinstance(each, ast.Name | ast.Attribute)]
    if any(isinstance(each, ast.Attribute) and each.attr == name for each in parts):
        return True
    given = [value for each in parts for value in values.get(ast.unparse(each), ())]
    return steps > 0 and any(_reads(each, name, values, steps - 1) for each in given)


def _acts(body: list[ast.stmt]) -> bool:
    """Return whether a block sets a command or publishes something that is not new and empty."""
    for statement in body:
        for target, value in assigned(statement):
            if isinstance(target, ast.Attribute) and not isinstance(value, ast.Constant):
                return True
        for call, name in calls(statement):
            new = all(isinstance(each, ast.Call) and not each.args + each.keywords for each in call.args)
            if name == "lookup_transform" or (name == "publish" and not new):
                return True
    return False


LOOKS = (turned,)
