"""Suspects in a drive for some seconds that never ends (`endless`), ends by the place (`by_place`), or begins again.

Those of a drive that begins again are about `again`.
"""

from __future__ import annotations

import ast

from gz_course.grader.feedback.facts.syntax import Words, assigned, functions, is_none, nodes_of, set_to, unparse, walk
from gz_course.grader.feedback.suspects.about import About
from gz_course.grader.feedback.suspects.steering.endless_drives import (
    TIMES,
    asked_for_none,
    in_init,
    is_zero,
    of_a_plain_drive,
    publish_calls,
    set_speeds,
)

STEPS = 5  # names followed at most  # names followed at most
PLACES = ("pose.position.x", "pose.position.y", "pose.orientation.", "position.x", "position.y", "twist.linear.")


@of_a_plain_drive(About.BY_PLACE)
def by_place(tree: ast.AST) -> Words:
    """Find a comparison of a place or a heading with a number, in a file that compares no time."""
    values = set_to(tree)
    compares = [
        node
        for node in nodes_of(tree, ast.Compare)
        if len(node.ops) == 1 and not any(is_none(each) for each in node.comparators)
    ]
    if any(_reads_time(side, values, STEPS) for node in compares for side in (node.left, *node.comparators)):
        return
    for node in compares:
        for side in (node.left, *node.comparators):
            if place := _place(side, values, STEPS):
                what = "the heading" if "orientation" in place else "the speed" if "twist" in place else "the place"
                coordinate = (
                    ", and a coordinate is not the way along a curve"
                    if "position" in place and "-" not in place
                    else ""
                )
                yield (
                    node,
                    f"{unparse(node)[:60]} asks for {what} ({place[:50]}) and not for the time that has "
                    f"passed{coordinate}",
                )
                break


def _reads_time(node: ast.expr, values: dict[str, list[ast.expr]], steps: int) -> bool:
    parts = [each for each in nodes_of(node, ast.Attribute, ast.Name)]
    if any((each.attr if isinstance(each, ast.Attribute) else each.id) in TIMES for each in parts):
        return True
    return steps > 0 and any(
        _reads_time(value, values, steps - 1)
        for each in parts
        for value in values.get(unparse(each), [])
        if value is not node
    )


def _place(node: ast.expr, values: dict[str, list[ast.expr]], steps: int) -> str:
    """Return the part of odometry's pose from which a value is made; empty if from none."""
    for each in walk(node):
        text = unparse(each) if isinstance(each, ast.Attribute) else ""
        if text.count(".") > 1 and (found := next((part for part in PLACES if part in text), "")):
            return text[text.index(found) :]
    if steps > 0:
        for each in nodes_of(node, ast.Attribute, ast.Name):
            for value in values.get(unparse(each), []):
                if value is not node and (found := _place(value, values, steps - 1)):
                    return found
    return ""


@of_a_plain_drive(About.AGAIN)
def set_again(tree: ast.AST) -> Words:
    """Find a start that is set back to None, or set again when the time is over."""
    init = in_init(tree)
    starts = {
        name
        for node in nodes_of(tree, ast.If, ast.IfExp)
        for test in _parts(node.test)
        if (name := asked_for_none(test))
    }
    for target, value in assigned(tree):
        name = unparse(target)
        if name in starts and "." in name and id(value) not in init and is_none(value):
            yield (
                target,
                f"{name} = None makes the next call take itself for the first one, so a new drive begins: leave "
                f"{name} as it is when you stop",
            )
    for block in nodes_of(tree, ast.If):
        for statement in block.body:
            for target, value in assigned(statement):
                name = unparse(target)
                if id(target) in init or isinstance(value, ast.Constant) or not _late(block.test, name, tree):
                    continue
                yield (
                    target,
                    f"{name} = {unparse(value)[:40]} stands below  if {unparse(block.test)[:60]}:, so it is "
                    "set again when the time is over, and a new drive begins: set it once, if it is None",
                )


def _parts(test: ast.expr) -> list[ast.expr]:
    return test.values if isinstance(test, ast.BoolOp) and isinstance(test.op, ast.Or) else [test]


def _late(test: ast.expr, start: str, tree: ast.AST) -> bool:
    """Return whether a condition holds as soon as more than some time has passed since a start."""
    values = set_to(tree)
    for part in _parts(test):
        if isinstance(part, ast.Compare) and isinstance(part.ops[0], ast.Gt | ast.GtE):
            sides = [part.left, *values.get(unparse(part.left), [])]
            for node in (each for side in sides for each in walk(side)):
                if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Sub) and unparse(node.right) == start:
                    return True
    return False


@of_a_plain_drive(About.AGAIN)
def falls_through(tree: ast.AST) -> Words:
    """Find a stop that is published below a condition, with the drive behind it in the same call."""
    for function in functions(tree):
        for i, block in enumerate(function.body):
            if not isinstance(block, ast.If) or block.orelse or _returns(block):
                continue
            stops = [call for call, _ in publish_calls(block)] if not any(True for _ in set_speeds(block)) else []
            drives = any(not is_zero(value) for each in function.body for _, value in set_speeds(each))
            behind = [call for each in function.body[i + 1 :] for call, _ in publish_calls(each)]
            if stops and drives and behind:
                yield (
                    stops[0],
                    f"the stop is published here, and then the same call goes on to line {behind[0].lineno}, which "
                    "publishes the drive: return after the stop, or put the drive into an else",
                )


def _returns(block: ast.If) -> bool:
    return isinstance(block.body[-1], ast.Return | ast.Raise | ast.Continue | ast.Break)


@of_a_plain_drive(About.AGAIN)
def for_a_moment(tree: ast.AST) -> Words:
    """Find a time that is compared with == and a number of seconds: it holds for a moment, or for a second."""
    values = set_to(tree)
    for node in (each for each in nodes_of(tree, ast.Compare) if len(each.ops) == 1):
        sides = (node.left, node.comparators[0])
        number = next((each.value for each in sides if isinstance(each, ast.Constant)), None)
        late = isinstance(node.ops[0], ast.Eq) and isinstance(number, int | float) and number >= 1
        if late and any(_reads_time(side, values, STEPS) for side in sides):
            yield node, f"{unparse(node)[:60]} holds for a moment and then no more: >= holds from then on"
