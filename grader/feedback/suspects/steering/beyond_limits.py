"""Suspects in what a command is made of behind its limit: sums of limited terms, speeds divided by a cosine.

A check that has seen a command beyond its limit asks for them. Where all but one way to a command are within the limit,
that one is beyond.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator

from gz_course.grader.feedback.facts.constants import named_numbers, number
from gz_course.grader.feedback.facts.syntax import Words, assigned, calls, functions, last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About
from gz_course.grader.feedback.suspects.steering.reaching_values import ReachingValues, UnknownValueError
from gz_course.grader.feedback.suspects.steering.speed_limits import LIMITING, limit_names, reads_limit

LIMIT = 1.5  # [rad/s] of this course's robots
DEEP = 12  # steps in which values are followed
SIGN = re.compile(r"sign|side|direction")
UNIT = frozenset({"cos", "sin", "tanh", "sign", "copysign", "exp"})  # results that are 1 at most
NOWHERE = "is not limited at all"
COLLECTED = frozenset({"sum", "mean", "fmean", "median", "average", "pop", "popleft", "get", "dot", "filter", "update"})
Found = tuple[int, str]


class Rate:
    """How large an expression may be: `most` is infinite if nothing limits it; `found` is why it is too large."""

    def __init__(self, most: float = float("inf"), limited: bool = False, found: Found | None = None) -> None:
        self.most, self.limited, self.found = most, limited, found


@suspicion_of(About.LIMIT)
def rates_beyond(tree: ast.Module) -> Words:
    """Find the one value of angular.z that may be beyond its limit, in a node that steers by a lidar."""
    if "angular.z" not in unparse(tree) or "LaserScan" not in unparse(tree):
        return
    values, known, found = ReachingValues(tree), named_numbers(tree), set()
    try:
        for target, value, function in _sent(tree, "angular.z"):
            for rate in _rates(value, function, values, known):
                if rate.found:
                    found.add(rate.found)
                elif rate.most == float("inf"):
                    found.add((target.lineno, f"{unparse(target)} = {unparse(value)[:60]} is not limited at all"))
                elif not rate.limited and rate.most > LIMIT:
                    found.add((value.lineno, f"{unparse(value)[:60]} may be up to {rate.most:.2f} rad/s"))
    except UnknownValueError:
        return
    limits = any(number(node, {}) == LIMIT for node in nodes_of(tree, ast.Constant))
    if len(found) == 1 and (limits or NOWHERE not in next(iter(found))[1]):
        line, said = found.pop()
        yield line, said


@suspicion_of(About.LIMIT)
def limited_on_one_side(tree: ast.Module) -> Words:
    """Find `if turning > 1.5: turning = 1.5` without the other side."""
    if "angular.z" not in unparse(tree) or "LaserScan" not in unparse(tree):
        return
    known, text = named_numbers(tree), unparse(tree)
    for node in walk(tree):
        match node:
            case ast.If(
                test=ast.Compare(left=left, ops=[ast.Gt() | ast.GtE()], comparators=[limit]),
                body=[ast.Assign(targets=[target], value=value)],
            ) if unparse(left) == unparse(target) and unparse(limit) == unparse(value):
                name = re.escape(unparse(left))
                other = re.search(rf"{name} <|> {name}\b|abs\({name}\) [<>]", text)
                other = other or re.search(rf"(max|min|clip|clamp|limit\w*|saturate)\([^\n)]*\b{name}\b", text)
                if number(limit, known) == LIMIT and not other:
                    said = f"if {unparse(node.test)[:50]} limits it on one side only, and it may be below"
                    yield node, f"{said} -{unparse(limit)}: limit both, max(-1.5, min(1.5, ...))"


def _sent(tree: ast.Module, name: str) -> Iterator[tuple[ast.expr, ast.expr, ast.FunctionDef]]:
    """Yield what is assigned to a part of a command: target, value and function."""
    for function in functions(tree):
        for target, value in assigned(function):
            if unparse(target).endswith(name):
                changed = any(isinstance(node, ast.AugAssign) and node.target is target for node in walk(function))
                if changed:
                    raise UnknownValueError
                yield target, value, function


def _rates(
    node: ast.expr, function: ast.FunctionDef, values: ReachingValues, known: dict[str, int | float], deep: int = DEEP
) -> list[Rate]:
    """Return how large an expression may be, for each of the values that it may have."""
    if deep == 0:
        raise UnknownValueError
    if (given := number(node, known)) is not None:
        return [Rate(abs(float(given)))]

    def inside(part: ast.expr) -> list[Rate]:
        return _rates(part, function, values, known, deep - 1)

    match node:
        case ast.UnaryOp(operand=operand):
            return inside(operand)
        case ast.IfExp(body=body, orelse=orelse):
            return inside(body) + inside(orelse)
        case ast.Name() | ast.Attribute():
            held = values.of(node, function)
            if not held:
                return [Rate(1.0 if SIGN.search(last_name(node).lower()) else float("inf"))]
            return [rate for value, place in held for rate in _rates(value, place, values, known, deep - 1)]
        case ast.BinOp(left=left, op=ast.Add() | ast.Sub(), right=right):
            return [_sum(node, one, other) for one in inside(left) for other in inside(right)]
        case ast.BinOp(left=left, op=ast.Mult(), right=right):
            return [_product(node, one, other) for one in inside(left) for other in inside(right)]
        case ast.BinOp(left=left, op=ast.Div(), right=right) if number(right, known):
            factor = 1 / abs(float(number(right, known) or 1))
            return [_product(node, one, Rate(factor)) for one in inside(left)]
        case ast.BinOp(left=left, op=ast.Div()):
            return [Rate(found=rate.found) for rate in inside(left)]
        case ast.Call():
            return _called(node, function, values, known, deep)
        case ast.Subscript(value=ast.Attribute() as kept) if unparse(kept).startswith("self."):
            raise UnknownValueError  # what was kept may be limited
        case ast.Subscript():
            return [Rate()]
    raise UnknownValueError


def _called(
    call: ast.Call, function: ast.FunctionDef, values: ReachingValues, known: dict[str, int | float], deep: int
) -> list[Rate]:
    """Return how large the result of a call may be."""
    name = last_name(call.func)
    if name in ("float", "abs", "fabs") and call.args:
        return _rates(call.args[0], function, values, known, deep - 1)
    own = values.own.get(name)
    both = {"min", "max"} <= (
        {inner for _, inner in calls(call)} | ({inner for _, inner in calls(own)} if own else set())
    )
    if name in LIMITING[2:] or name == "saturate" or both or (own and "clip" in {inner for _, inner in calls(own)}):
        limits = [abs(float(each)) for part in call.args if (each := number(part, known)) is not None]
        limits += [abs(float(each)) for inner, _ in calls(call) for part in inner.args if (each := number(part, known))]
        return [Rate(max(limits) if limits else LIMIT, limited=True)]
    if own is not None:
        if any(isinstance(node, ast.Compare) for node in walk(own)):
            raise UnknownValueError  # it may limit by comparisons
        return [rate for value, place in values.returned(own) for rate in _rates(value, place, values, known, deep - 1)]
    if name in ("min", "max") and len(call.args) == 2 and any(number(part, known) is not None for part in call.args):
        parts = [rate for part in call.args for rate in _rates(part, function, values, known, deep - 1)]
        most = max(rate.most for rate in parts)
        way = "from above" if name == "min" else "from below"
        said = f"{unparse(call)[:60]} limits it {way} only"
        return [Rate(most, found=(call.lineno, said) if most == float("inf") else None)]
    if name in COLLECTED:
        raise UnknownValueError  # what was collected may be limited
    return [Rate(1.0)] if name in UNIT else [Rate()]


def _sum(node: ast.BinOp, one: Rate, other: Rate) -> Rate:
    if found := one.found or other.found:
        return Rate(found=found)
    text, most = unparse(node)[:60], one.most + other.most
    if one.limited and other.limited and most > LIMIT:
        said = f"{text} adds two terms that are limited each, and their sum may be {most:.1f} rad/s: limit the sum"
        return Rate(found=(node.lineno, said))
    if (one.limited or other.limited) and most > LIMIT:
        return Rate(found=(node.lineno, f"{text} adds something to what is limited already: limit the sum, last"))
    return Rate(most, limited=one.limited or other.limited)


def _product(node: ast.BinOp, one: Rate, other: Rate) -> Rate:
    if found := one.found or other.found:
        return Rate(found=found)
    most = one.most * other.most
    limited = one.limited or other.limited
    if limited and most > LIMIT and min(one.most, other.most) > 1:
        said = f"{unparse(node)[:60]} multiplies what is limited already: limit last"
        return Rate(found=(node.lineno, said))
    return Rate(most, limited=limited)


# What a speed may be: speed_limit at most, from 0 to 1, 1 at least, a number, or anything.
AT_MOST, SHARE, AT_LEAST, FREE = "speed_limit", "share", "1 at least", "free"
Speed = str | float | Found


@suspicion_of(About.SPEED_LIMIT)
def speeds_beyond(tree: ast.Module) -> Words:
    """Find the one value of linear.x that may be beyond the parameter speed_limit."""
    if "speed_limit" not in unparse(tree) or "LaserScan" not in unparse(tree):
        return
    speeds, found = Speeds(tree), set()
    try:
        for _, value, function in _sent(tree, "linear.x"):
            for speed in speeds.of(value, function):
                if isinstance(speed, tuple):
                    found.add(speed)
                elif isinstance(speed, float) and speed > 0:
                    said = f"{unparse(value)[:60]} may be {speed:g} m/s, whatever speed_limit is"
                    found.add((value.lineno, said))
    except UnknownValueError:
        return
    if len(found) == 1:
        line, said = found.pop()
        yield line, said


class Speeds:
    """What expressions of one file may be, as speeds."""

    def __init__(self, tree: ast.Module) -> None:
        self.values, self.known, self.limits = ReachingValues(tree), named_numbers(tree), limit_names(tree)

    def of(self, node: ast.expr, function: ast.FunctionDef, deep: int = DEEP) -> list[Speed]:
        """Return what an expression may be, for each of the values that it may have."""
        if deep == 0:
            raise UnknownValueError
        if reads_limit(node) or unparse(node) in self.limits:
            return [AT_MOST]
        if (given := number(node, self.known)) is not None:
            return [float(given)]

        def inside(part: ast.expr) -> list[Speed]:
            return [FREE] if _is_size(part) else self.of(part, function, deep - 1)

        match node:
            case ast.IfExp(body=body, orelse=orelse):
                return inside(body) + inside(orelse)
            case ast.Name() | ast.Attribute():
                held = self.values.of(node, function)
                return [each for value, place in held for each in self.of(value, place, deep - 1)] or [FREE]
            case ast.BinOp(left=left, op=op, right=right):
                positive = _positive(right)
                return [_of_both(node, op, one, other, positive) for one in inside(left) for other in inside(right)]
            case ast.Call():
                return self._called(node, inside)
        return [FREE]

    def _called(self, node: ast.Call, inside: Callable[[ast.expr], list[Speed]]) -> list[Speed]:
        """Return what the result of a call may be; `inside` returns it for one of its arguments."""
        match node:
            case ast.Call(args=[one, other]) if last_name(node.func) in ("min", "max"):
                small = last_name(node.func) == "min"
                return [_chosen(small, a, b) for a in inside(one) for b in inside(other)]
            case ast.Call(args=[_]) if last_name(node.func) in ("min", "max"):
                return [FREE]
            case ast.Call(args=args) if last_name(node.func) == "min" and any(AT_MOST in inside(each) for each in args):
                return [AT_MOST]
            case ast.Call(args=[_, low, high]) if (
                last_name(node.func) == "clip" and number(low, self.known) is not None
            ):
                return inside(high)
            case ast.Call(args=[one]) if last_name(node.func) in ("float", "abs", "fabs"):
                return inside(one)
            case ast.Call():
                name = last_name(node.func)
                limits = [number(part, self.known) for part in node.args[1:]]
                if name in LIMITING[2:] and limits and all(each is not None and 0 <= each <= 1 for each in limits):
                    return [SHARE]
                own = name in self.values.own or unparse(node.func).startswith("self.")
                if own or name in LIMITING or name in ("min", "max", "get"):
                    raise UnknownValueError
                return [SHARE if name in UNIT else FREE]
        return [FREE]


def _positive(node: ast.expr) -> bool:
    """Say whether an expression is certainly not below 0: a size without its sign, perhaps times a number."""
    match node:
        case ast.Call(func=func):
            return last_name(func) in ("abs", "fabs", "min", "hypot")
        case ast.BinOp(left=left, op=ast.Mult() | ast.Div(), right=right):
            return all(_positive(each) or isinstance(each, ast.Constant | ast.Name) for each in (left, right)) and (
                _positive(left) or _positive(right)
            )
        case ast.Constant(value=int() | float() as value):
            return value >= 0
    return False


def _is_size(node: ast.expr) -> bool:
    """Say whether an expression is made of what has no sign, whatever it is otherwise."""
    return _positive(node) and not isinstance(node, ast.Constant) and "min(" not in unparse(node)


def _of_both(node: ast.BinOp, op: ast.operator, one: Speed, other: Speed, positive: bool) -> Speed:
    """Return what a sum, a difference, a product or a quotient of two values may be."""
    for each in (one, other):
        if isinstance(each, tuple):
            return each
    text, shown, right = unparse(node)[:60], unparse(node.left)[:30], unparse(node.right)[:40]
    share = [each == SHARE or (isinstance(each, float) and 0 <= each <= 1) for each in (one, other)]
    if isinstance(one, float) and isinstance(op, ast.Sub) and one <= 1 and (positive or share[1]):
        return SHARE
    if isinstance(one, float) and isinstance(op, ast.Add) and one >= 1 and positive:
        return AT_LEAST
    if isinstance(op, ast.Mult) and AT_MOST in (one, other):
        return _limit_times(node, one, other, share)
    if isinstance(op, ast.Mult) and all(share):
        return SHARE
    if one != AT_MOST:
        if other == AT_MOST and not isinstance(op, ast.Sub):
            raise UnknownValueError
        return FREE
    if isinstance(op, ast.Div):
        return _limit_over(node, other, positive)
    if isinstance(op, ast.Sub):
        if positive or share[1]:
            return AT_MOST
        return node.lineno, f"{text} subtracts {right}, which is below 0 at times: limit last, min(...)"
    if isinstance(op, ast.Add) and (reads_limit(node.left) or isinstance(node.left, ast.Name | ast.Attribute)):
        return node.lineno, f"{text} adds {right} to {shown}, which is the limit already: limit last, min(...)"
    raise UnknownValueError


def _limit_times(node: ast.BinOp, one: Speed, other: Speed, share: list[bool]) -> Speed:
    """Return what the product of speed_limit and another value may be."""
    text, shown, right = unparse(node)[:60], unparse(node.left)[:30], unparse(node.right)[:40]
    if one == other or share[other != AT_MOST]:
        return AT_MOST
    factor, times = (right, shown) if one == AT_MOST else (shown, right)
    return node.lineno, f"{text} multiplies {times} by {factor}, which is above 1 at times: limit last, min(...)"


def _limit_over(node: ast.BinOp, other: Speed, positive: bool) -> Speed:
    """Return what speed_limit divided by another value may be."""
    text, shown, right = unparse(node)[:60], unparse(node.left)[:30], unparse(node.right)[:40]
    if other == AT_LEAST or (isinstance(other, float) and other >= 1):
        return AT_MOST
    if other == FREE and positive:
        raise UnknownValueError
    below = "is 1 at most, so the quotient is larger" if other == SHARE else "is below 1 at times"
    return node.lineno, f"{text} divides {shown} by {right}, which {below}: limit last, min(...)"


def _chosen(small: bool, one: Speed, other: Speed) -> Speed:
    """Return what the smaller, or the larger, of two values may be."""
    kinds = (one, other)
    if AT_MOST in kinds:
        rest = other if one == AT_MOST else one
        if small or rest == AT_MOST or (isinstance(rest, float) and rest <= 0):
            return AT_MOST
        if isinstance(rest, float):
            return rest
        raise UnknownValueError
    numbers = [each for each in kinds if isinstance(each, float)]
    shares = [each == SHARE or (isinstance(each, float) and 0 <= each <= 1) for each in kinds]
    if all(shares) or (small and any(shares) and not numbers):
        return SHARE
    if small and numbers:
        return SHARE if numbers[0] <= 1 else FREE
    if not small and numbers and numbers[0] <= 0:
        return other if one is numbers[0] else one
    return FREE
