"""Angles in the wrong unit or form: degrees for sin and cos, x and y of atan2 exchanged, rays counted from the end."""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.constants import named_numbers, number
from gz_course.grader.feedback.facts.syntax import Place, Words, assigned, nodes_of, unparse, walk
from gz_course.grader.feedback.slips import slip, slip_of

OF_ANGLES = frozenset({"sin", "cos", "tan"})
IN_RADIANS = frozenset({"angle_min", "angle_max", "angle_increment"})


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
