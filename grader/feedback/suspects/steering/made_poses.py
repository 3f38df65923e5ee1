"""Suspects in poses that a node makes of exact odometry: sums of turning rates, averages, and angles cut at pi."""

from __future__ import annotations

import ast
import re

from gz_course.grader.feedback.facts.constants import named_numbers, number
from gz_course.grader.feedback.facts.syntax import Words, assigned, functions, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

RATE = re.compile(r"\btwist\.(?:twist\.)?angular\.z")
REST = "the pose of /odom is exact here: take it as it comes"


@suspicion_of(About.HEADING)
def heading_of_a_position(tree: ast.AST) -> Words:
    """Find `atan2(p.y, p.x)` of a position of /odom: the direction from the origin to the robot."""
    positions = {unparse(one) for one, value in assigned(tree) if unparse(value).endswith(".pose.pose.position")}
    for node in walk(tree):
        match node:
            case ast.Call(args=[ast.Attribute(value=one, attr="y"), ast.Attribute(value=other, attr="x")]):
                whole = unparse(one)
                if whole != unparse(other) or not re.search(r"atan2$|arctan2$", unparse(node.func)):
                    continue
                if whole in positions or whole.endswith(".pose.pose.position"):
                    yield (
                        node,
                        f"{unparse(node)[:60]} is the direction from the origin to the robot, not where the robot "
                        "looks: the heading is 2 * atan2(orientation.z, orientation.w)",
                    )


@suspicion_of(About.HEADING)
def summed_rates(tree: ast.AST) -> Words:
    """Find `self.yaw += message.twist.twist.angular.z * dt` in a callback of odometry."""
    if "Odometry" not in unparse(tree):
        return
    for function in functions(tree):
        twists = {unparse(one) for one, value in assigned(function) if unparse(value).endswith(".twist.twist")}
        rates = {unparse(one) for one, value in assigned(function) if RATE.search(unparse(value))}
        rates |= {f"{name}.angular.z" for name in twists}
        for node in nodes_of(function, ast.AugAssign):
            parts = {unparse(each) for each in walk(node.value)}
            if isinstance(node.op, ast.Add) and (RATE.search(unparse(node.value)) or parts & rates):
                yield (
                    node,
                    f"{unparse(node)[:60]} adds up turning rates: it begins at 0 wherever the robot looks, and it "
                    "is as wrong as the time between messages that it takes for granted; the heading is 2 * "
                    "atan2(orientation.z, orientation.w)",
                )


def _used(value: ast.expr) -> set[str]:
    return {unparse(each) for each in nodes_of(value, ast.Attribute, ast.Name)}


@suspicion_of(About.POSE, ast.FunctionDef)
def averaged_poses(function: ast.FunctionDef, tree: ast.AST) -> Words:
    """Find the mean of an old pose and a new one, by which the robot seems to be where it was."""
    known = named_numbers(tree)
    if ".pose.pose" not in unparse(function):
        return
    for target, value in assigned(function):
        for node in walk(value):
            match node:
                case ast.BinOp(
                    left=ast.BinOp(left=one, op=ast.Mult(), right=_),
                    op=ast.Add(),
                    right=ast.BinOp(left=other, op=ast.Mult(), right=_),
                ):
                    a, b = number(one, known), number(other, known)
                    if a is not None and b is not None and abs(a + b - 1) < 1e-6 and unparse(target) in _used(value):
                        yield (
                            node,
                            f"{unparse(node)[:60]} averages the pose with older ones, so it lags behind the "
                            f"robot, and the walls and the steering with it; {REST}",
                        )


@suspicion_of(About.ANGLE, ast.BinOp, ast.Call)
def cut_at_pi(node: ast.BinOp | ast.Call) -> Words:
    """Find a difference of angles that is reduced by half a turn: `% pi`, `remainder(x, pi)`."""
    match node:
        case ast.BinOp(op=ast.Mod(), right=divisor):
            pass
        case ast.Call(func=ast.Name(id="remainder" | "fmod"), args=[_, divisor]):
            pass
        case ast.Call(func=ast.Attribute(attr="remainder" | "fmod" | "mod"), args=[_, divisor]):
            pass
        case _:
            return
    if re.fullmatch(r"(?:math\.|np\.|numpy\.)?pi", unparse(divisor)):
        yield (
            f"{unparse(node)[:60]} takes away half turns, so what is behind seems to be ahead: a whole turn is 2 * pi"
        )
