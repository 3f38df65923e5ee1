"""Suspects about angles: parts of a quaternion taken for the heading, degrees for radians, x before y.

What is put into the x and the y of a message says which name is which; calls of the file's functions hand it on.
"""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.constants import Number, named_numbers, number
from gz_course.grader.feedback.facts.syntax import (
    Words,
    assigned,
    called,
    calls,
    children,
    functions,
    last_name,
    nodes_of,
    unparse,
    walk,
)
from gz_course.grader.feedback.slips.geometry.angles import SOME, pairs
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

BEFORE = ("heading_formulas",)

LIMITS = frozenset({"min", "max", "clip", "float", "abs", "fabs"})  # what keeps a number within [-1, 1]
MOST = 3.2  # [rad] a larger limit of an angle was meant in degrees
PER_DEGREE = 0.1  # [rad/s] a gain below it may well be meant for degrees
SINES = frozenset({"cos", "sin", "tan"})
TO_DEGREES = frozenset({"degrees", "rad2deg"})
TO_RADIANS = frozenset({"radians", "deg2rad"})
HEADING = re.compile(r"heading|yaw|theta|\bth\b|phi|psi|angle|direction|orientation", re.IGNORECASE)
OF_SCANS = re.compile(r"\bangle_(?:min|max|increment)\b")
X = re.compile(r"\bd?x\b|\[0\]|\bd_?x\b|\bdelta_x\b|\b(?:forward|ahead)\b")
Y = re.compile(r"\bd?y\b|\[1\]|\bd_?y\b|\bdelta_y\b|\b(?:leftward|left|aside|sideways|lateral)\b")
OFFSETS = ast.Add | ast.Sub
STEPS = 4  # calls that hand a name on, at most


def _quaternions(tree: ast.AST) -> set[str]:
    """Return the names that stand for a quaternion: those that are assigned something.orientation."""
    found = {
        unparse(target)
        for target, value in assigned(tree)
        if isinstance(value, ast.Attribute) and value.attr in ("orientation", "rotation")
    }
    own = {each.name: [one.arg for one in each.args.args if one.arg != "self"] for each in functions(tree)}
    for call, name in calls(tree):
        given = zip(own.get(name, []), call.args, strict=False)
        found |= {one for one, value in given if unparse(value).endswith((".orientation", ".rotation"))}
    return found


def _headings(tree: ast.AST) -> Iterator[ast.expr]:
    """Yield what is assigned to a heading, and what a function with such a name returns."""
    yield from (value for target, value in assigned(tree) if HEADING.search(unparse(target)))
    for function in functions(tree):
        if HEADING.search(function.name):
            found = (each.value for each in nodes_of(function, ast.Return))
            yield from (value for value in found if value is not None)


def _part(node: ast.AST, names: set[str]) -> str:
    """Return which part of a quaternion an expression is, such as `z`; empty if it is none."""
    if not isinstance(node, ast.Attribute) or node.attr not in ("x", "y", "z", "w"):
        return ""
    of = unparse(node.value)
    return node.attr if of in names or of.endswith((".orientation", ".rotation")) else ""


@suspicion_of(About.ANGLE)
def headings_in_degrees(tree: ast.AST) -> Words:
    """Find a heading of a quaternion that a function returns in degrees, in a file that makes no radians of it."""
    if called(tree) & TO_RADIANS or _to_radians(tree):
        return
    aims = any(called(n) & {"atan2", "arctan2"} and not _of_quaternion(n) for n in walk(tree) if _is_call(n))
    for node in walk(tree):
        value = node.value if isinstance(node, ast.Return) else None
        if aims and value is not None and _in_degrees(value) and _of_quaternion(value):
            yield (
                value,
                f"{unparse(value)[:60]} is a heading in degrees, and atan2 returns the direction to a place in "
                "radians; both must be in one unit",
            )


def _signed(tree: ast.AST, names: set[str]) -> bool:
    """Say whether the sign of z is asked for, which tells left from right."""
    asking = (
        node
        for node in walk(tree)
        if isinstance(node, ast.Compare)
        or (isinstance(node, ast.Call) and last_name(node.func) in ("copysign", "sign"))
    )
    return any(_part(each, names) == "z" for node in asking for each in walk(node))


def _wrong_heading(value: ast.expr, parts: set[str], names: set[str]) -> str:
    used, right = called(value) - LIMITS, "the heading is 2 * atan2(orientation.z, orientation.w)"
    if not used and len(parts) == 1:
        (part,) = parts
        what = {"z": "the sine of half of it", "w": "the cosine of half of it"}.get(part, "nearly 0 on flat ground")
        return f"orientation is a quaternion, whose {part} is {what}; {right}"
    if used == {"atan2"} and (flat := sorted(parts - {"w"})) and "z" not in parts:
        return f"{flat[0]} is nearly 0 on flat ground, so this is, too; {right}"
    if used == {"atan2"} and parts == {"z", "w"} and isinstance(value, ast.Call):
        if _part(value.args[0], names) == "w":
            return f"atan2 takes the sine first, which is z; {right}"
        return f"that is half of it; {right}" if all(_part(each, names) for each in value.args) else ""
    if used and used <= {"acos", "arccos"} and parts == {"w"}:
        return f"acos is never negative, so whoever has turned to the right seems to have turned to the left; {right}"
    if used and used <= {"asin", "arcsin"} and parts == {"z"} and isinstance(value, ast.Call):
        return f"that is half of it; {right}"
    return ""


@suspicion_of(About.HEADING)
def quaternion_parts(tree: ast.AST) -> Words:
    """Find headings that are made of a quaternion in a wrong way."""
    names = _quaternions(tree)
    for value in _headings(tree):
        parts = {part for node in walk(value) if (part := _part(node, names))}
        if not parts:
            continue
        words = _wrong_heading(value, parts, names)
        if words and not (words.startswith("acos") and _signed(tree, names)):
            yield value, f"{unparse(value)[:60]} is taken for the heading: {words}"


def _in_degrees(value: ast.AST) -> bool:
    return bool(called(value) & TO_DEGREES) or bool(re.search(r"\* 180(?:\.0)? / (?:\w+\.)?pi", unparse(value)))


def _to_radians(value: ast.AST) -> bool:
    return bool(re.search(r"pi / 180|/ 180(?:\.0)? \* (?:\w+\.)?pi", unparse(value)))


@suspicion_of(About.ANGLE)
def degrees_for_radians(tree: ast.AST) -> Words:
    """Find an angle in degrees in cos or sin, and one in radians that is converted to radians."""
    in_degrees = {unparse(target) for target, value in assigned(tree) if _in_degrees(value)}
    of_scans = {
        unparse(target)
        for target, value in assigned(tree)
        if OF_SCANS.search(unparse(value)) and not called(value) & (TO_DEGREES | TO_RADIANS | {"int", "round"})
    }
    of_scans -= in_degrees
    for node in nodes_of(tree, ast.Call):
        name, given = last_name(node.func), [*node.args]
        text = unparse(node)[:60]
        if name in SINES and given and not called(given[0]) & TO_RADIANS and not _to_radians(given[0]):
            parts = {unparse(each) for each in nodes_of(given[0], ast.Name, ast.Attribute)}
            if _in_degrees(given[0]) or parts & in_degrees:
                yield node, f"{text} gets an angle in degrees: cos and sin take radians"
        of_scan = given and (OF_SCANS.search(unparse(given[0])) or unparse(given[0]) in of_scans)
        if name in TO_RADIANS and of_scan and not _in_degrees(given[0]):
            yield node, f"{text} converts what is in radians already: all angles of a scan are"


def _counting(value: ast.AST, known: dict[str, Number]) -> Iterator[ast.AST]:
    """Yield the nodes that make the size of a value: not those of comparisons, nor what has a gain per degree."""
    if isinstance(value, ast.Compare):
        return
    if isinstance(value, ast.BinOp) and isinstance(value.op, ast.Mult):
        gains = [each for side in (value.left, value.right) if (each := number(side, known)) is not None]
        if any(abs(each) < PER_DEGREE for each in gains):
            return
    yield value
    for child in children(value):
        yield from _counting(child, known)


@suspicion_of(About.ANGLE)
def turning_rates_in_degrees(tree: ast.AST) -> Words:
    """Find an angular.z that is assigned degrees."""
    in_degrees = {unparse(target) for target, value in assigned(tree) if _in_degrees(value)}
    known = named_numbers(tree)
    for target, value in assigned(tree):
        parts = {unparse(each) for each in _counting(value, known) if isinstance(each, ast.Name | ast.Attribute)}
        wrong = (_in_degrees(value) or parts & in_degrees) and not called(value) & TO_RADIANS
        if wrong and unparse(target).endswith("angular.z"):
            yield value, "angular.z gets degrees per second here: it is in radians per second"


@suspicion_of(About.HEADING, ast.Call)
def sine_first(node: ast.Call) -> Words:
    """Find atan2 of x and y."""
    if last_name(node.func) not in ("atan2", "arctan2") or len(node.args) != 2:
        return
    first, second = (unparse(each) for each in node.args)
    if X.search(first) and Y.search(second) and not Y.search(first) and not X.search(second):
        yield f"{unparse(node)[:60]}: atan2 takes y first, atan2(y, x)"


@suspicion_of(About.ANGLE)
def degrees_beside_radians(tree: ast.AST) -> Words:
    """Find the sum or difference of an angle in degrees and the direction that atan2 returns."""
    values = list(assigned(tree))
    in_degrees = {unparse(target) for target, value in values if _in_degrees(value)}
    in_radians = {unparse(target) for target, value in values if _of_atan2(value)} - in_degrees
    for node in nodes_of(tree, ast.BinOp):
        if not isinstance(node.op, ast.Sub | ast.Add):
            continue
        for one, other in ((node.left, node.right), (node.right, node.left)):
            degrees = unparse(one) in in_degrees or _in_degrees(one)
            radians = unparse(other) in in_radians or _of_atan2(other)
            if degrees and radians:
                yield (
                    node,
                    f"`{unparse(node)[:70]}`: {unparse(one)[:40]} is in degrees, and {unparse(other)[:40]} "
                    "in radians; both must be in one unit, and the sines of Python and ROS's messages take radians",
                )


def _of_atan2(value: ast.AST) -> bool:
    """Return whether a value is what atan2 returns, in radians."""
    return bool(called(value) & {"atan2", "arctan2"}) and not _in_degrees(value) and isinstance(value, ast.Call)


@suspicion_of(About.WRAP)
def differences(tree: ast.AST) -> Words:
    """Find the difference of a direction and a heading in a file that brings no angle between -pi and pi."""
    text = unparse(tree)
    if re.search(
        r"remainder\(|fmod\(|% |atan2\((?:math\.|np\.)?sin|arctan2\(np\.sin|(?:while|if) .*(?:>|<) -?(?:\w+\.)?pi", text
    ):
        return
    aimed = {
        unparse(target)
        for target, value in assigned(tree)
        if called(value) & {"atan2", "arctan2"} and isinstance(target, ast.Name)
    }
    for node in nodes_of(tree, ast.BinOp):
        if not isinstance(node.op, ast.Sub):
            continue
        direction = called(node.left) & {"atan2", "arctan2"} or unparse(node.left) in aimed
        if HEADING.search(unparse(node.right)) and direction:
            yield (
                node,
                f"{unparse(node)[:60]} is not brought between -pi and pi, so the robot may turn the long way round",
            )


def _is_call(node: ast.AST) -> bool:
    return isinstance(node, ast.Call) and last_name(node.func) in ("atan2", "arctan2")


def _of_quaternion(node: ast.AST) -> bool:
    parts = {each.attr for each in nodes_of(node, ast.Attribute)}
    return {"z", "w"} <= parts


@suspicion_of(About.ANGLE)
def limits_in_degrees(tree: ast.AST) -> Words:
    """Find an angle in radians that is compared with a number above pi, in a file that makes no degrees."""
    if called(tree) & (TO_DEGREES | TO_RADIANS) or not called(tree) & {"atan2", "arctan2"}:
        return
    numbers = [each.value for each in nodes_of(tree, ast.Constant)]
    if any(each in (180, 360, 57.3, 57.29578) for each in numbers if isinstance(each, int | float)):
        return
    known = named_numbers(tree)
    for node in nodes_of(tree, ast.Compare):
        if len(node.ops) != 1:
            continue
        left = node.left
        if isinstance(left, ast.Call) and last_name(left.func) in ("abs", "fabs") and left.args:
            left = left.args[0]
        name = last_name(left.func if isinstance(left, ast.Call) else left)
        limit = number(node.comparators[0], known)
        if re.search(r"angle|bearing|heading|yaw|turn|theta", name) and limit is not None and MOST < limit <= 180:
            yield (
                node,
                f"`{unparse(node)[:60]}`: an angle in radians is at most 3.14, and {limit:g} degrees are "
                f"{math.radians(limit):.2g}",
            )


@suspicion_of(About.AXES)
def exchanged_directions(tree: ast.AST) -> Words:
    """Find atan2 of what is put into the x of a message, and of what is put into its y, in this order."""
    axes = _axes(tree)
    for function in functions(tree):
        known = axes.get(function.name, {})
        for call, name in calls(function):
            if name not in ("atan2", "arctan2") or len(call.args) != 2:
                continue
            if [known.get(_bare(each)) for each in call.args] == ["x", "y"]:
                ahead, left = (unparse(each) for each in call.args)
                right = f"{name}({left}, {ahead})"
                yield (
                    call,
                    f"{unparse(call)[:60]}: {name} takes y first, what is to the left, and that is {left} here: "
                    f"{right}",
                )


@suspicion_of(About.AXES)
def other_turns(tree: ast.AST) -> Words:
    """Find a pair of sums that turns a place, but not by plus the angle whose cosine and sine it has."""
    axes = _axes(tree)
    for function, ((first, row), (second, below)) in pairs(tree):
        known = axes.get(function.name, {})
        names = {axis: name for name in row if (axis := known.get(name))}
        if set(names) != {"x", "y"}:
            continue
        ahead, left = names["x"], names["y"]
        found = {(round(each[ahead], 6), round(each[left], 6)) for each in (row, below)}
        cosine, sine = round(math.cos(SOME), 6), round(math.sin(SOME), 6)
        if found != {(cosine, -sine), (sine, cosine)}:
            yield (
                first,
                f"{unparse(first)[:50]} and {unparse(second)[:50]} turn the wrong way: for x, it is "
                f"{ahead} * cos - {left} * sin, and for y {ahead} * sin + {left} * cos",
            )


def _axes(tree: ast.AST) -> dict[str, dict[str, str]]:
    """Return which names of each function are an x, and which a y."""
    found: dict[str, dict[str, str]] = {}
    for function in functions(tree):
        known = found.setdefault(function.name, {})
        for target, value in assigned(function):
            if isinstance(target, ast.Attribute) and target.attr in ("x", "y") and isinstance(value, ast.Name):
                known[value.id] = target.attr
    made = {
        function.name: [each.arg for each in function.args.args if each.arg != "self"] for function in functions(tree)
    }
    for _ in range(STEPS):
        for function in functions(tree):
            for call, name in calls(function):
                for parameter, given in zip(made.get(name, []), call.args, strict=False):
                    if axis := found[function.name].get(_bare(given)):
                        found[name].setdefault(parameter, axis)
    for function in functions(tree):
        known = found[function.name]
        for target, value in assigned(function):
            if isinstance(target, ast.Name) and (axis := known.get(_bare(value))):
                known.setdefault(target.id, axis)
    return found


def _bare(node: ast.expr) -> str:
    """Return a name, also with a constant added, such as the place of the camera; empty for anything else."""
    if isinstance(node, ast.BinOp) and isinstance(node.op, OFFSETS) and isinstance(node.right, ast.Constant):
        return _bare(node.left)
    return node.id if isinstance(node, ast.Name) else ""
