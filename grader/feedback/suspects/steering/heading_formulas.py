"""Suspects in headings that formulas give, poses made of exact odometry, and the side to which a robot turns."""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Callable

from gz_course.grader.feedback.facts.constants import named_numbers, number
from gz_course.grader.feedback.facts.syntax import (
    Words,
    assigned,
    called,
    functions,
    last_name,
    nodes_of,
    unparse,
    walk,
)
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About
from gz_course.grader.feedback.suspects.steering.headings import HEADING

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
RATE = re.compile(r"\btwist\.(?:twist\.)?angular\.z")
REST = "the pose of /odom is exact here: take it as it comes"
WHOLE_TURN = re.compile(r"2(?:\.0)? \* [\w.]*pi|[\w.]*pi \* 2|\btau\b|6\.28")
AIMED = frozenset({"atan2", "arctan2"})


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


@suspicion_of(About.SIGN)
def wrong_side(tree: ast.AST) -> Words:
    """Find `angular.z = -1.2 if error > 0 else 1.2`, where the error is the direction of the goal minus the heading."""
    pairs = list(assigned(tree))
    aimed = {unparse(target) for target, value in pairs if called(value) & AIMED}
    errors = {unparse(target) for target, value in pairs if _goal_minus_heading(value, aimed)}
    for node in walk(tree):
        if isinstance(node, ast.If):
            sides = [_turn(each) for each in node.body]
        elif isinstance(node, ast.Assign) and isinstance(node.value, ast.IfExp) and _turns(node.targets[0]):
            sides = [node.value.body]
        else:
            continue
        test = node.test if isinstance(node, ast.If) else node.value.test  # type: ignore[attr-defined]
        match test:
            case ast.Compare(left=error, ops=[ast.Gt() | ast.GtE()], comparators=[ast.Constant(value=limit)]):
                side = 1 if isinstance(limit, int | float) and limit >= 0 else 0
            case ast.Compare(left=error, ops=[ast.Lt() | ast.LtE()], comparators=[ast.Constant(value=0)]):
                side = -1
            case _:
                continue
        given = next((each for each in sides if each is not None), None)
        if given is None or unparse(error) not in errors or not side:
            continue
        negative = isinstance(given, ast.UnaryOp) and isinstance(given.op, ast.USub)
        if negative == (side > 0) and (negative or isinstance(given, ast.Constant)):
            goal, turn = ("left", "right") if side > 0 else ("right", "left")
            yield (
                node,
                f"where {unparse(test)}, the goal is on the {goal}, and angular.z becomes {unparse(given)}, "
                f"which turns the robot to the {turn}, away from its goal; a positive angular.z turns to the left",
            )


@suspicion_of(About.WRAP)
def whole_turns(tree: ast.AST) -> Words:
    """Find `error = (atan2(dy, dx) - yaw) % (2 * pi)`, which is never negative, so all turns go to the left."""
    pairs = list(assigned(tree))
    aimed = {unparse(target) for target, value in pairs if called(value) & AIMED}
    text = unparse(tree)
    for target, value in pairs:
        match value:
            case ast.BinOp(left=error, op=ast.Mod(), right=whole):
                pass
            case ast.Call(func=ast.Attribute(attr="mod"), args=[error, whole]):
                pass
            case _:
                continue
        name = unparse(target)
        if not WHOLE_TURN.search(unparse(whole)) or not _goal_minus_heading(error, aimed):
            continue
        if not re.search(rf"{re.escape(name)} (?:>=?|-=?) [\w.]*pi", text):  # what follows may bring it below pi
            yield (
                value,
                f"`{unparse(value)[:80]}` lies between 0 and 2 pi, so a goal a little to the right is nearly a "
                f"whole turn to the left: {name} must lie between -pi and pi, as remainder(..., 2 * pi) does",
            )


def _goal_minus_heading(value: ast.expr, aimed: set[str]) -> bool:
    for node in nodes_of(value, ast.BinOp):
        if isinstance(node.op, ast.Sub):
            left, right = unparse(node.left), unparse(node.right)
            if (called(node.left) & AIMED or left in aimed) and HEADING.search(right) and right not in aimed:
                return True
    return False


def _turns(target: ast.expr) -> bool:
    return unparse(target).endswith("angular.z")


def _turn(statement: ast.stmt) -> ast.expr | None:
    """Return what a statement assigns to angular.z; None if it does not."""
    if isinstance(statement, ast.Assign) and _turns(statement.targets[0]):
        return statement.value
    return None
