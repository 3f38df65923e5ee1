"""Suspects in a node that keeps a distance: the wrong side, sums of positions, stops for what is near anywhere."""

from __future__ import annotations

import ast
import re

from gz_course.grader.feedback.facts.syntax import (
    Words,
    assigned,
    called,
    calls,
    functions,
    last_name,
    nodes_of,
    unparse,
    walk,
)
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

KEPT = re.compile(r"gap|desired|wanted|1\.2\b|keep|spacing|target_dist", re.IGNORECASE)
MEASURED = re.compile(r"dist|hypot|range|length|separation", re.IGNORECASE)
LESS = re.compile(r"dist|error|gap|hypot|excess|behind|err\b", re.IGNORECASE)
NEAREST = re.compile(r"\b(?:min|nanmin|amin)\((?:\w+\.)*ranges\)|\.ranges\)?\.min\(\)|\bmin\(\w+(?:\.\w+)*\.ranges\)")


def _speeds(tree: ast.AST) -> list[tuple[ast.expr, ast.expr]]:
    return [(target, value) for target, value in assigned(tree) if unparse(target).endswith("linear.x")]


@suspicion_of(About.SILENCED)
def timers_that_end_themselves(tree: ast.AST) -> Words:
    """Find a timer that is cancelled in its own callback where a distance is small, and never begins again."""
    if called(tree) & {"reset"} or "create_subscription" not in called(tree):
        return
    near = [each for each in nodes_of(tree, ast.If) if LESS.search(unparse(each.test))]
    under = {id(node) for each in near for part in each.body for node in walk(part)}
    for target, value in assigned(tree):
        if not isinstance(value, ast.Call) or last_name(value.func) != "create_timer":
            continue
        timer, callback = unparse(target), last_name(value.args[1]) if len(value.args) > 1 else ""
        for function in (each for each in functions(tree) if each.name == callback):
            for call, name in calls(function):
                ends = name == "cancel" and unparse(call.func) == f"{timer}.cancel"
                if id(call) in under and (ends or (name == "destroy_timer" and timer in map(unparse, call.args))):
                    yield (
                        call,
                        f"{unparse(call)} ends the timer for good, so {callback} is never called again: return "
                        "instead, or send a Twist of zeros",
                    )


@suspicion_of(About.WHOLE_SPEED)
def whole_speeds(tree: ast.AST) -> Words:
    """Find a speed that int() or // makes a whole number."""
    for _, value in _speeds(tree):
        whole = [node for node in nodes_of(value, ast.Call) if unparse(node.func) == "int"]
        if whole or any(isinstance(node, ast.FloorDiv) for node in walk(value)):
            yield value, f"{unparse(value)[:60]} leaves out what is behind the point, so every speed below 1 m/s is 0"


def _drives(body: list[ast.stmt]) -> bool:
    return any(not _is_zero(value) for _, value in _speeds(ast.Module(body, [])))


def _is_zero(value: ast.expr) -> bool:
    return isinstance(value, ast.Constant) and not value.value


@suspicion_of(About.GAP)
def gap_minus_distance(tree: ast.AST) -> Words:
    """Find the gap minus the distance in a file that takes no speed with a minus sign."""
    if any(isinstance(node, ast.USub) for _, value in _speeds(tree) for node in walk(value)):
        return
    for node in nodes_of(tree, ast.BinOp):
        if not isinstance(node.op, ast.Sub):
            continue
        left, right = unparse(node.left), unparse(node.right)
        if KEPT.search(left) and MEASURED.search(right) and not MEASURED.search(left):
            yield (
                node,
                f"{unparse(node)[:60]} is below zero where the distance is too large: the speed is made of the "
                "distance minus the gap",
            )


@suspicion_of(About.GAP, ast.If)
def drives_when_near(node: ast.If, tree: ast.AST) -> Words:
    """Find a condition that lets a robot drive only where the distance, or the error, is small."""
    if not isinstance(node.test, ast.Compare) or len(node.test.ops) != 1:
        return
    test, left, right = node.test, unparse(node.test.left), unparse(node.test.comparators[0])
    less = isinstance(test.ops[0], ast.Lt | ast.LtE) and LESS.search(left) and "abs" not in left
    more = isinstance(test.ops[0], ast.Gt | ast.GtE) and LESS.search(right) and not LESS.search(left)
    if not (less or more) or not _drives(node.body) or _drives(node.orelse):
        return
    others = [value for _, value in _speeds(tree) if not any(value is each for each in walk(node))]
    if all(_is_zero(value) for value in others):
        yield f"it drives only where {unparse(test)[:60]}, which does not hold where it is behind"


@suspicion_of(About.GAP, ast.AugAssign)
def added_positions(node: ast.AugAssign) -> Words:
    """Find a position of an odometry that is added to a sum with each message."""
    if isinstance(node.op, ast.Add) and ".position." in unparse(node.value):
        name = unparse(node.target)
        if name.startswith("self."):
            yield (
                f"{name} grows by the whole position with each message: an odometry says where the robot is, not "
                "how far it has come since the message before"
            )


@suspicion_of(About.STANDSTILL)
def stops_for_all_sides(tree: ast.AST) -> Words:
    """Find `if min(scan.ranges) < 0.5: command.linear.x = 0.0`, where the test is true for what is behind, too."""
    nearest = {unparse(one) for one, value in assigned(tree) if NEAREST.search(unparse(value))}
    for node in nodes_of(tree, ast.If):
        test = unparse(node.test)
        parts = {unparse(each) for each in walk(node.test)}
        if " < " not in test or not (NEAREST.search(test) or parts & nearest):
            continue
        body = ast.Module(body=node.body, type_ignores=[])
        given = {unparse(one): unparse(value) for one, value in assigned(body)}
        stops = any(one.endswith("linear.x") and value in ("0", "0.0") for one, value in given.items())
        if (stops or "Twist()" in unparse(body)) and not any(one.endswith("angular.z") for one in given):
            more = "" if called(body) - {"Twist", "publish"} else ", and as long as it stands nothing changes"
            yield (
                node,
                f"`if {test[:60]}` stops the robot for whatever is near on any side, also behind it{more}: look at the "
                "rays ahead only, and turn",
            )
