"""Suspects in what a wall follower's turning rate is made of: degrees with a gain per radian, centimetres, gains
behind a limit, the first item of a tuple, 0 for a ray that hits nothing.
"""

from __future__ import annotations

import ast
import re

from gz_course.grader.feedback.facts.constants import Number, named_numbers, number
from gz_course.grader.feedback.facts.ros_parameters import reads
from gz_course.grader.feedback.facts.syntax import Words, assigned, calls, functions, last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

BEFORE = ("beyond_limits",)

TO_DEGREES, TO_RADIANS = frozenset({"degrees", "rad2deg"}), frozenset({"radians", "deg2rad"})
ENDS = TO_RADIANS | {"cos", "sin", "tan", "len", "range", "print", "isfinite"}  # what degrees do not get through
PER_DEGREE = 0.1  # [rad/s] a gain below it may well be meant for degrees
BY_HAND = re.compile(r"\* 180(?:\.0)? / (?:\w+\.)?pi|/ (?:\w+\.)?pi \* 180|\* 57\.\d|\* \(180(?:\.0)? / (?:\w+\.)?pi\)")
BACK = re.compile(r"\* (?:\w+\.)?pi / 180|/ 180(?:\.0)? \* (?:\w+\.)?pi|/ 57\.\d")
STEPS = 6
LIMIT = 1.5  # [rad/s] of this course's robots
HUNDREDS = (100, 1000, 0.01, 0.001)


def _steers(tree: ast.AST) -> bool:
    text = unparse(tree)
    return "angular.z" in text and "LaserScan" in text


@suspicion_of(About.DEGREES)
def degrees_in_gains(tree: ast.Module) -> Words:
    """Find an angle in degrees that goes into angular.z by a gain that is no gain per degree."""
    if not _steers(tree):
        return
    known = named_numbers(tree)
    for function in functions(tree):
        names: dict[str, int] = {}
        columns: dict[str, dict[int, int]] = {}
        for _ in range(STEPS):
            _columns(function, names, known, columns)
            for target, value in assigned(function):
                if line := _degrees(value, names, known):
                    names.setdefault(unparse(target), line)
        for target, value in assigned(function):
            if unparse(target).endswith("angular.z") and (line := _degrees(value, names, known)):
                yield (
                    line,
                    "here an angle is in degrees, and angular.z is made of it as if it were in radians, so a heading "
                    "that is wrong by a few degrees already turns the robot as fast as it may; leave all angles in "
                    "radians",
                )
                return


def _columns(
    function: ast.FunctionDef, names: dict[str, int], known: dict[str, Number], columns: dict[str, dict[int, int]]
) -> None:
    """Follow degrees through lists of tuples: what is appended to one comes out of the loops over it."""
    for call, name in calls(function):
        if name == "append" and isinstance(call.func, ast.Attribute) and call.args:
            items = call.args[0].elts if isinstance(call.args[0], ast.Tuple) else [call.args[0]]
            for place, item in enumerate(items):
                if line := _degrees(item, names, known):
                    columns.setdefault(unparse(call.func.value), {})[place] = line
    for loop in nodes_of(function, ast.For, ast.comprehension):
        items = loop.target.elts if isinstance(loop.target, ast.Tuple) else [loop.target]
        for place, line in columns.get(unparse(loop.iter), {}).items():
            if place < len(items):
                names.setdefault(unparse(items[place]), line)


def _degrees(node: ast.expr, names: dict[str, int], known: dict[str, Number]) -> int:
    """Return the line that makes the degrees an expression is in; 0 if it is in none, or in too small a share."""
    text = unparse(node)
    if isinstance(node, ast.Name | ast.Attribute) and text in names:
        return names[text]
    if isinstance(node, ast.Compare | ast.Constant | ast.Name):
        return 0
    if isinstance(node, ast.BinOp):
        if BACK.search(text):
            return 0
        if BY_HAND.search(text):
            return node.lineno
        if isinstance(node.op, ast.Mult | ast.Div):
            for side in (node.left, node.right):
                value = number(side, known)
                if value is not None and isinstance(node.op, ast.Div) and side is node.right:
                    value = 1 / value if value else None
                if value is not None and abs(value) < PER_DEGREE:
                    return 0
        return _degrees(node.left, names, known) or _degrees(node.right, names, known)
    if isinstance(node, ast.Call):
        name = last_name(node.func)
        if name in TO_DEGREES:
            return node.lineno
        inside = [] if name in ENDS else [*node.args, *(each.value for each in node.keywords)]
        return next((line for each in inside if (line := _degrees(each, names, known))), 0)
    if isinstance(node, ast.ListComp | ast.GeneratorExp):
        return _degrees(node.elt, names, known)
    if isinstance(node, ast.Subscript):
        return _degrees(node.value, names, known)
    if isinstance(node, ast.IfExp):
        return _degrees(node.body, names, known) or _degrees(node.orelse, names, known)
    return _degrees(node.operand, names, known) if isinstance(node, ast.UnaryOp) else 0


@suspicion_of(About.UNIT)
def centimetres(tree: ast.Module) -> Words:
    """Find the parameter that says how far, or a range, that is multiplied by 100, 1000, or the inverse of them."""
    if not _steers(tree):
        return
    known, asked = named_numbers(tree), {id(call) for call, _ in reads(tree)}
    for node in nodes_of(tree, ast.BinOp):
        if not isinstance(node.op, ast.Mult | ast.Div):
            continue
        factor, other = number(node.right, known), node.left
        if factor is None and isinstance(node.op, ast.Mult):
            factor, other = number(node.left, known), node.right
        if factor in HUNDREDS and any(id(each) in asked for each in walk(other)):
            yield (
                node,
                f"{unparse(node)[:70]} is in another unit than metres, which the parameter and all ranges are in",
            )


@suspicion_of(About.LIMIT, ast.FunctionDef, first=True)
def gains_behind_limits(function: ast.FunctionDef, tree: ast.Module) -> Words:
    """Find a rate that is limited first and then multiplied by a gain, or has something added, on its way out."""
    known = named_numbers(tree)
    limited = {unparse(target) for target, value in assigned(function) if _is_limited(value, known)}
    values = {unparse(target): value for target, value in assigned(function)}
    for node in nodes_of(function, ast.BinOp):
        if not isinstance(node.op, ast.Mult):
            continue
        for one, other in ((node.left, node.right), (node.right, node.left)):
            gain = number(other, known)
            inside = _is_limited(one, known) or unparse(one) in limited
            if inside and gain is not None and abs(gain) > 1 and _goes_out(function, node, values):
                yield (
                    node,
                    f"{unparse(node)[:70]} multiplies by {gain:g} what is limited already, so it goes beyond "
                    "the limit: limit last",
                )


def _is_limited(node: ast.expr, known: dict[str, Number]) -> bool:
    """Say whether an expression is a value between -1.5 and 1.5: clip, or min and max."""
    if not isinstance(node, ast.Call):
        return False
    if last_name(node.func) == "float" and node.args:
        return _is_limited(node.args[0], known)
    if last_name(node.func) not in ("clip", "min", "max", "clamp", "limited", "limit", "saturate"):
        return False
    numbers = [number(each, known) for each in nodes_of(node, ast.expr)]
    return LIMIT in numbers


def _goes_out(function: ast.FunctionDef, node: ast.AST, values: dict[str, ast.expr]) -> bool:
    """Return whether an expression reaches angular.z with nothing but signs on its way."""
    for target, value in assigned(function):
        if unparse(target).endswith("angular.z"):
            parts = list(walk(value))
            names = [unparse(each) for each in parts if isinstance(each, ast.Name | ast.Attribute)]
            parts += [each for name in names if name in values for each in walk(values[name])]
            limits = any(
                isinstance(each, ast.Call)
                and last_name(each.func) in ("clip", "min", "max")
                and any(inner is node for inner in walk(each))
                for each in parts
            )
            if any(each is node for each in parts) and not limits:
                return True
    return False


@suspicion_of(About.FARTHEST)
def least_tuples(tree: ast.Module) -> Words:
    """Find min() of tuples in which the range is not the first item, with no key."""
    if not _steers(tree):
        return
    for function in functions(tree):
        single = {
            unparse(each)
            for loop in nodes_of(function, ast.For, ast.comprehension)
            if ".ranges" in unparse(loop.iter)
            for each in ([loop.target] if not isinstance(loop.target, ast.Tuple) else loop.target.elts[1:])
        } | {unparse(target) for target, value in assigned(function) if ".ranges[" in unparse(value)}
        rows: dict[str, ast.Tuple] = {}
        for call, name in calls(function):
            if name == "append" and call.args and isinstance(call.args[0], ast.Tuple):
                rows[unparse(call.func).rpartition(".")[0]] = call.args[0]
        for target, value in assigned(function):
            if isinstance(value, ast.ListComp) and isinstance(value.elt, ast.Tuple):
                rows[unparse(target)] = value.elt
        for call, name in calls(function):
            row = rows.get(unparse(call.args[0])) if name in ("min", "sorted") and len(call.args) == 1 else None
            if row is None or call.keywords or not row.elts:
                continue
            items = [unparse(each) for each in row.elts]
            if items[0] not in single and set(items[1:]) & single:
                yield (
                    call,
                    f"{unparse(call)[:60]} compares the first items of the tuples, {items[0][:30]}, and not their "
                    "ranges: put the range first, or pass a key",
                )


@suspicion_of(About.FARTHEST)
def whole_metres(tree: ast.Module) -> Words:
    """Find int(r) and round(r) of a range: what is left are whole metres."""
    if not _steers(tree):
        return
    for function in functions(tree):
        single = {unparse(target) for target, value in assigned(function) if ".ranges[" in unparse(value)}
        for loop in nodes_of(function, ast.For, ast.comprehension):
            last = loop.target.elts[-1] if isinstance(loop.target, ast.Tuple) else loop.target
            if ".ranges" in unparse(loop.iter) and "range(" not in unparse(loop.iter):
                single.add(unparse(last))
        for call, name in calls(function):
            given = unparse(call.args[0]) if len(call.args) == 1 else ""
            if name in ("int", "round") and (given in single or ".ranges[" in given.partition("(")[0]):
                yield call, f"{unparse(call)[:60]} makes whole metres of a range: leave it as it is"


@suspicion_of(About.ZERO)
def zero_for_nothing(tree: ast.Module) -> Words:
    """Find a ray that hits nothing, or is not valid, that counts as 0 m."""
    if not _steers(tree):
        return
    text = unparse(tree)
    if re.search(r"> (?:0(?:\.\d*)?|\w+\.range_min|self\.range_min)\b", text):
        return  # a range of 0 is left out again
    for node in walk(tree):
        code, zero = unparse(node) if isinstance(node, ast.expr | ast.Assign) else "", False
        match node:
            case ast.Call() if last_name(node.func) == "nan_to_num":
                zero = any(each.arg == "posinf" and number(each.value, {}) == 0 for each in node.keywords)
            case ast.Call(args=[test, one, other]) if last_name(node.func) == "where":
                zero = 0 in (number(one, {}), number(other, {})) and bool(re.search("isinf|isfinite", unparse(test)))
            case ast.IfExp(test=test, body=one, orelse=other):
                zero = 0 in (number(one, {}), number(other, {})) and bool(
                    re.search(r"isinf|isfinite|\binf\b|range_max", unparse(test))
                )
            case ast.Assign(targets=[ast.Subscript() as target], value=value):
                zero = number(value, {}) == 0 and bool(re.search(r"isinf|isfinite|\binf\b", unparse(target)))
            case ast.If(test=test, body=[ast.Assign(targets=[ast.Name()], value=value)]):
                code = f"if {unparse(test)}: {unparse(node.body[0])}"
                zero = number(value, {}) == 0 and bool(re.search(r"isinf|isfinite|\binf\b|range_max", unparse(test)))
        if zero:
            yield (
                node,
                f"{code[:80]} makes a ray that hits nothing the nearest of all, at 0 m: leave such rays out, or let "
                "them count as far away",
            )
            return
