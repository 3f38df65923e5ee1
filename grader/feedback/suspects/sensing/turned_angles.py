"""Suspects in an angle that a gyroscope should give: set back in each message, of another time, or an orientation."""

from __future__ import annotations

import ast

from gz_course.grader.feedback.facts.constants import named_numbers, number
from gz_course.grader.feedback.facts.syntax import Words, calls, functions, last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About
from gz_course.grader.feedback.suspects.sensing.gyroscopes import reads_rates


@suspicion_of(About.GYROSCOPE)
def orientations(tree: ast.AST) -> Words:
    """Find the orientation in a message of a gyroscope where its rates are read nowhere."""
    heard = {
        last_name(call.args[2])
        for call, name in calls(tree)
        if name == "create_subscription" and len(call.args) > 2 and last_name(call.args[0]) == "Imu"
    }
    for function in (each for each in functions(tree) if each.name in heard and not any(reads_rates(tree))):
        found = [node for node in nodes_of(function, ast.Attribute) if node.attr == "orientation"]
        for node in found[:1]:
            said = "the angle of an orientation jumps from pi to -pi and never comes to 2 pi: add up angular_velocity.z"
            yield node, f"{said} * time"


@suspicion_of(About.GYROSCOPE)
def set_back(tree: ast.AST) -> Words:
    """Find an angle that is set to a number just before something is added to it, in each message."""
    for function in reads_rates(tree):
        blocks = [(node, block) for node in walk(function) for block in (_block(node, "body"), _block(node, "orelse"))]
        for above, block in blocks:
            once = unparse(above.test) if isinstance(above, ast.If) and block is above.body else ""
            numbers: dict[str, ast.stmt] = {}
            for statement in block:
                match statement:
                    case ast.Assign(targets=[ast.Attribute() as target], value=ast.Constant(value=int() | float())):
                        numbers[unparse(target)] = statement
                    case ast.AugAssign(target=ast.Attribute() as target):
                        made = numbers.get(unparse(target))
                        if made is not None and unparse(target) not in once:
                            yield (
                                made,
                                f"{unparse(made)} is done before each step is added, so what was turned before is "
                                "forgotten: set it once",
                            )


def _block(node: ast.AST, name: str) -> list[ast.stmt]:
    """Return a block of a statement; empty for what has none, such as an expression."""
    block = getattr(node, name, None)
    return block if isinstance(block, list) else []


@suspicion_of(About.GYROSCOPE)
def steps_of_timers(tree: ast.AST) -> Words:
    """Find a sum in the callback of a timer that counts another time for each call than the period of the timer."""
    known = named_numbers(tree)
    periods = {
        last_name(call.args[1]): number(call.args[0], known)
        for call, name in calls(tree)
        if name == "create_timer" and len(call.args) > 1
    }
    for function in functions(tree) if any(reads_rates(tree)) else ():
        period = periods.get(function.name)
        for node in walk(function) if period else ():
            if not isinstance(node, ast.AugAssign) or not isinstance(node.op, ast.Add) or period is None:
                continue
            if not isinstance(node.value, ast.BinOp) or not isinstance(node.value.op, ast.Mult):
                continue
            step = number(node.value.right, known)
            if step and abs(step - period) > 1e-6:
                yield (
                    node,
                    f"{unparse(node)[:60]} counts {step:g} s for each call, and the timer calls {function.name} "
                    f"every {period:g} s",
                )
