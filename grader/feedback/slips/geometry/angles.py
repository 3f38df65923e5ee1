"""Angles in the wrong unit, form or order, and pairs of sums of cosines and sines that turn no point.

Source: https://en.wikipedia.org/wiki/Rotation_matrix (in two dimensions).
"""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Iterator, Mapping

from gz_course.grader.feedback.facts.constants import named_numbers, number
from gz_course.grader.feedback.facts.syntax import (
    Place,
    Words,
    assigned,
    children,
    functions,
    last_name,
    nodes_of,
    unparse,
    walk,
)
from gz_course.grader.feedback.slips import slip, slip_of

OF_ANGLES = frozenset({"sin", "cos", "tan"})
IN_RADIANS = frozenset({"angle_min", "angle_max", "angle_increment"})
MAKES = "euler_from_quaternion"
HEADING = re.compile(r"yaw|heading|theta|\bth\b")
ORDER = ("roll", "pitch", "yaw")
SOME = 0.7  # [rad] at which a pair is tried
APART = 3  # lines between the two
Row = dict[str, float]  # by factor, what it is multiplied with
Pair = tuple[tuple[ast.BinOp, Row], tuple[ast.BinOp, Row]]


def _calls(tree: ast.AST) -> Iterator[tuple[ast.Call, str]]:
    for node in nodes_of(tree, ast.Call):
        owner, _, name = unparse(node.func).rpartition(".")
        if owner in ("", "math", "np", "numpy"):
            yield node, name


@slip_of(ast.BinOp)
def whole_parts_of_pi(node: ast.BinOp) -> Words:
    """Find pi // 2, which is 1.0."""
    match node:
        case ast.BinOp(op=ast.FloorDiv(), left=left, right=ast.Constant(value=int(parts))) if parts:
            text = unparse(node)
            if unparse(left).lstrip("-") in ("pi", "math.pi", "np.pi", "numpy.pi"):
                angle = -math.pi if text.startswith("-") else math.pi
                right = f"{text.replace('//', '/')} is {angle / parts:.2f}"
                yield f"{text} is {angle // parts:g}, because // rounds down: {right}"


@slip
def degrees_for_radians(tree: ast.AST) -> Iterator[Place]:
    """Find sin(90) and sin(degrees(x)), which take radians, and radians(scan.angle_min), which is in radians."""
    known = named_numbers(tree)
    for call, name in _calls(tree):
        if not call.args:
            continue
        code, given = unparse(call)[:60], call.args[0]
        if name in OF_ANGLES:
            value = number(given, known)
            inner = unparse(given.func).rpartition(".")[2] if isinstance(given, ast.Call) else ""
            if inner in ("degrees", "rad2deg") or (isinstance(value, int) and abs(value) > 2 * math.pi):
                yield call.lineno, f"{code}: {name}() takes radians, not degrees; math.radians() converts them"
        elif name in ("radians", "deg2rad") and isinstance(given, ast.Attribute) and given.attr in IN_RADIANS:
            yield call.lineno, f"{code}: {given.attr} of a LaserScan is in radians already"


@slip
def exchanged_atan2(tree: ast.AST) -> Iterator[Place]:
    for call, name in _calls(tree):
        if name not in ("atan2", "arctan2") or len(call.args) != 2:
            continue
        first, second = (_axis(each) for each in call.args)
        if (first, second) == ("x", "y"):
            yield call.lineno, f"{unparse(call)[:60]}: {name} takes y first and x second"


def _axis(node: ast.expr) -> str:
    """Return x or y if that is what an expression is called, alone or as a difference; else an empty text."""
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Sub):
        left, right = _axis(node.left), _axis(node.right)
        return left if left == right else ""
    if isinstance(node, ast.Name | ast.Attribute):
        match = re.search(r"(?:^[a-z]?|[._]|d|delta)([xy])$", unparse(node))
        return match[1] if match else ""
    return ""


@slip
def quotients_for_directions(tree: ast.AST) -> Iterator[Place]:
    """Find atan(dy / dx), which knows no direction to the back."""
    for call, name in _calls(tree):
        given = call.args[0] if len(call.args) == 1 else None
        if name not in ("atan", "arctan") or not isinstance(given, ast.BinOp) or not isinstance(given.op, ast.Div):
            continue
        if (_axis(given.left), _axis(given.right)) == ("y", "x"):
            yield (
                call.lineno,
                f"{unparse(call)[:60]} is between -90 and 90 degrees, so what lies behind seems to be ahead, and "
                f"it divides by 0 to the side: atan2({unparse(given.left)}, {unparse(given.right)})",
            )


@slip_of(ast.Assign)
def quaternions_for_angles(node: ast.Assign) -> Words:
    """Find `yaw = orientation.z`: the z of a quaternion is the sine of half the angle."""
    if not isinstance(node.value, ast.Attribute):
        return
    target, value = unparse(node.targets[0]), unparse(node.value)
    if re.search(r"(?:yaw|heading|theta|angle)$", target) and re.search(
        r"(?:orientation|rotation|\bq|quat)\.z$", value
    ):
        yield (
            f"{value} is no angle: z of a quaternion is the sine of half of it; the heading of a robot on the "
            "ground is 2 * math.atan2(q.z, q.w)"
        )


@slip
def rays_from_the_end(tree: ast.AST) -> Iterator[Place]:
    """Find the bearing `scan.angle_max + i * scan.angle_increment`, which begins where a scan ends."""
    counters = {
        unparse(node.target.elts[0] if isinstance(node.target, ast.Tuple) else node.target)
        for node in nodes_of(tree, ast.For, ast.comprehension)
        if isinstance(node.iter, ast.Call)
        and (unparse(node.iter.func), len(node.iter.args)) in (("enumerate", 1), ("range", 1))
    }
    for node in walk(tree):
        match node:
            case ast.BinOp(op=ast.Add(), left=first, right=ast.BinOp(op=ast.Mult(), left=one, right=other)):
                texts = {unparse(one), unparse(other)}
                end = unparse(first).endswith("angle_max")
                if end and texts & counters and any(each.endswith("angle_increment") for each in texts):
                    code = unparse(node)
                    right = code.replace("angle_max", "angle_min")
                    yield node.lineno, f"{code[:80]} begins where the scan ends: ray 0 looks to angle_min, {right[:80]}"


def _of_a_frame(tree: ast.AST, value: ast.expr) -> bool:
    """Return whether a coordinate is that of a frame: made with a transform, or put into the x of a message."""
    made = {unparse(target) for target, each in assigned(tree) if each is value}
    return "translation" in unparse(value) or any(
        isinstance(target, ast.Attribute) and target.attr == "x" and (each is value or unparse(each) in made)
        for target, each in assigned(tree)
        if not (isinstance(target, ast.Attribute) and unparse(target.value) == "self")
    )


@slip_of(ast.FunctionDef)
def exchanged_sines(function: ast.FunctionDef, tree: ast.AST) -> Words:
    """Find the x of a ray that is made with its sine, with the y that is made with its cosine."""
    bearings = {
        unparse(target)
        for target, value in assigned(function)
        if {"angle_min", "angle_increment"} <= {getattr(each, "attr", "") for each in walk(value)}
    }
    found: dict[tuple[str, str], ast.expr] = {}
    for target, value in assigned(function):
        waves = {name for call, name in _calls(value) if name in ("sin", "cos") and unparse(call.args[0]) in bearings}
        if len(waves) == 1 and isinstance(target, ast.Name | ast.Attribute):
            found.setdefault((_axis(target), waves.pop()), value)
    if ("x", "sin") in found and ("y", "cos") in found and len(found) == 2 and _of_a_frame(tree, found["x", "sin"]):
        yield (
            found["x", "sin"],
            f"x = {unparse(found['x', 'sin'])[:60]}: the angle of a ray counts from straight ahead, so x, "
            "ahead, has its cosine, and y, to the left, its sine",
        )


def _is_euler(node: ast.AST) -> bool:
    return isinstance(node, ast.Call) and last_name(node.func) == MAKES


@slip
def other_angle(tree: ast.AST) -> Iterator[Place]:
    """Find `yaw, pitch, roll = euler_from_quaternion(q)`, and its first element taken for the heading."""
    if MAKES in {function.name for function in functions(tree)}:
        return  # one of the student's own may return them in any order
    names = {unparse(target) for target, value in assigned(tree) if _is_euler(value)}
    for node in nodes_of(tree, ast.Assign):
        target, value = node.targets[0], node.value
        if isinstance(target, ast.Tuple | ast.List) and len(target.elts) == len(ORDER):
            if _is_euler(value) or unparse(value) in names:
                for place, each in enumerate(target.elts[:2]):
                    if HEADING.search(unparse(each).lower()):
                        yield node.lineno, _said(unparse(each), place)
        elif isinstance(value, ast.Subscript) and (_is_euler(value.value) or unparse(value.value) in names):
            index = value.slice.value if isinstance(value.slice, ast.Constant) else None
            if isinstance(index, int) and index in (0, 1) and HEADING.search(unparse(target).lower()):
                yield node.lineno, _said(unparse(target), index)


def _said(name: str, place: int) -> str:
    return (
        f"{name} gets the {ORDER[place]}, which is nearly 0 on flat ground: {MAKES}() returns roll, pitch and yaw, in "
        "this order"
    )


@slip_of(ast.Call)
def other_order(call: ast.Call) -> Words:
    """Find `euler_from_quaternion([q.w, q.x, q.y, q.z])`: w is the last one."""
    name = last_name(call.func)
    given = call.args[0] if call.args else None
    if name == MAKES and isinstance(given, ast.List | ast.Tuple):
        parts = "".join(last_name(each) for each in given.elts)
        if sorted(parts) == sorted("xyzw") and parts != "xyzw":
            yield f"{MAKES}() takes x, y, z, w in this order, and gets {', '.join(parts)}"


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
