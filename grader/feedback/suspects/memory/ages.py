"""Suspects in conditions on the age of a message.

Some use the old messages and drop the fresh ones (`age`); others drop none, however old it is (`any_age`), or nearly
all (`young_age`).
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.constants import Number, named_numbers, number
from gz_course.grader.feedback.facts.syntax import Words, assigned, calls, last_name, nodes_of, set_to, unparse, walk
from gz_course.grader.feedback.suspects import suspicion, suspicion_of
from gz_course.grader.feedback.suspects.about import About, Suspect

OLDER, YOUNGER = (ast.Gt, ast.GtE), (ast.Lt, ast.LtE)
LEAVES = ast.Return | ast.Continue
STEPS = 3  # names followed at most
EVER = 1e6  # [s] a limit that no message of a program that runs now comes near, other than by another clock
SOON = 0.15  # [s] a limit that the messages of a sensor with ten a second pass before the next one comes
NANO = 1e9


@suspicion_of(About.AGE, ast.If)
def turned(node: ast.If, tree: ast.AST) -> Words:
    """Find `if age > LIMIT:` before what uses the message, and `if age < LIMIT: return`."""
    values = set_to(tree)
    drops, uses = isinstance(node.body[-1], LEAVES) and not _acts(node.body), _acts(node.body)
    for test, holds in _parts(node.test, True):
        asked = _older(test, values)
        if asked is None or not (drops or uses) or _always_holds(test):
            continue
        if (asked == holds) == uses:
            yield (
                test,
                f"`{unparse(node.test)[:60]}` lets only old messages through, and drops the fresh ones, whose "
                "age is nearly 0: the comparison is the wrong way round",
            )


@suspicion
def of_any_age(tree: ast.AST) -> Iterator[Suspect]:
    """Find a limit of the age that is never passed, and a branch for old messages that does not drop them."""
    values, names = set_to(tree), named_numbers(tree)
    for node in nodes_of(tree, ast.If):
        for test, holds in _parts(node.test, True):
            asked = _older(test, values)
            if asked is None or not isinstance(test, ast.Compare):
                continue
            if _always_holds(test) and holds:
                yield (
                    test.lineno,
                    About.ANY_AGE,
                    f"`{unparse(test)[:60]}` holds for every age, so no message is too old",
                )
                continue
            limit, large = _limit(test, values, names)
            if limit and not large:
                said = (
                    f"the limit {limit} in `{unparse(node.test)[:60]}` is so small that nearly every message is too old"
                )
                yield test.lineno, About.YOUNG_AGE, said
            elif limit:
                said = f"the limit {limit} in `{unparse(node.test)[:60]}` is so large that no message is too old"
                yield test.lineno, About.ANY_AGE, said
            elif asked == holds and not node.orelse and _says(node.body):
                said = f"`{unparse(node.test)[:60]}` only reports an old message; without return, it is used"
                yield test.lineno, About.ANY_AGE, said


def _always_holds(test: ast.expr) -> bool:
    """Return whether a comparison says of an absolute value what is true of any."""
    match test:
        case ast.Compare(left=left, ops=[ast.GtE()], comparators=[ast.Constant(value=int() | float() as limit)]):
            return limit <= 0 and _is_absolute(left)
        case ast.Compare(left=ast.Constant(value=int() | float() as limit), ops=[ast.LtE()], comparators=[right]):
            return limit <= 0 and _is_absolute(right)
    return False


def _is_absolute(node: ast.expr) -> bool:
    return isinstance(node, ast.Call) and last_name(node.func) in ("abs", "fabs")


def _says(body: list[ast.stmt]) -> bool:
    """Return whether every statement of a block is a call, as of a logger, or does nothing."""
    return all(isinstance(each, ast.Pass | ast.Expr) for each in body)


def _limit(test: ast.Compare, values: dict[str, list[ast.expr]], names: dict[str, Number]) -> tuple[str, bool]:
    """Return the limit of an age as it is written, and whether it is large; empty if it may be right, or is unknown."""
    age, other = test.left, test.comparators[0]
    if not _is_age(age, values, STEPS):
        age, other = other, age
    whole = 1.0 if _in_seconds(age, values, STEPS) else NANO
    given = values.get(unparse(other), [other])
    known = number(other, names)
    large = (known is not None and abs(known) >= EVER * whole) or (len(given) == 1 and _endless(given[0]))
    if not large and (known is None or not 0 < known < SOON * whole):
        return "", False
    shown = f"{number(given[0], {}):g}" if _is_number(given[0]) else unparse(given[0])
    return (shown if shown == unparse(other) else f"{unparse(other)} = {shown}"), large


def _is_number(node: ast.expr) -> bool:
    """Return whether an expression is a number as it is written."""
    return isinstance(node, ast.Constant) and isinstance(node.value, int | float)


def _endless(node: ast.expr) -> bool:
    """Return whether an expression is infinity."""
    return unparse(node) in ("float('inf')", "math.inf", "np.inf", "numpy.inf", "inf")


def _in_seconds(node: ast.AST, values: dict[str, list[ast.expr]], steps: int) -> bool:
    """Return whether nanoseconds are divided, or not used at all, also by the names in an expression."""
    parts = [each for each in nodes_of(node, ast.Name, ast.Attribute)]
    if any(isinstance(each, ast.BinOp) and isinstance(each.op, ast.Div | ast.Mult) for each in walk(node)):
        return True
    if any(isinstance(each, ast.Attribute) and each.attr == "nanoseconds" for each in parts):
        return False
    given = [value for each in parts for value in values.get(unparse(each), ()) if not isinstance(value, ast.Constant)]
    return steps <= 0 or all(_in_seconds(each, values, steps - 1) for each in given)


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
    for each in walk(node):
        if isinstance(each, ast.BinOp) and isinstance(each.op, ast.Sub):
            return _reads(each.left, "now", values, steps) and _reads(each.right, "stamp", values, steps)
        if isinstance(each, ast.Name | ast.Attribute) and steps:
            given = values.get(unparse(each), [])
            if len(given) == 1 and _is_age(given[0], values, steps - 1):
                return True
    return False


def _reads(node: ast.expr, name: str, values: dict[str, list[ast.expr]], steps: int) -> bool:
    """Return whether an expression has an attribute of that name, also by the names in it."""
    parts = [each for each in nodes_of(node, ast.Name, ast.Attribute)]
    if any(isinstance(each, ast.Attribute) and each.attr == name for each in parts):
        return True
    given = [value for each in parts for value in values.get(unparse(each), ())]
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
