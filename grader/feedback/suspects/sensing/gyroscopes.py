"""Suspects in what adds up the rates of a gyroscope: times that are no times, headings that jump, the wrong axis."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Words, assigned, called, last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion, suspicion_of
from gz_course.grader.feedback.suspects.about import About, Suspect
from gz_course.grader.feedback.suspects.steering.headings import TO_RADIANS

TIMES = re.compile(r"stamp|nanosec|now\(|clock|seconds|time|elapsed|passed|\bdt\b|delta", re.IGNORECASE)
WRAPS = frozenset({"remainder", "fmod", "atan2", "arctan2", "wrap", "normalize", "normalize_angle"})
BY_HAND = re.compile(r"\bpi / 180|/ 180(?:\.0)? \* (?:\w+\.)?pi|/ 57\.\d+|\* 0\.01745")  # degrees to radians
EARLIER = re.compile(r"last|before|prev|old|earlier", re.IGNORECASE)
SPREAD = "says how much the rates scatter (their noise), not how far they are off"
NO_MEANS = {  # what is called instead of the mean: what it gives
    **dict.fromkeys(("std", "stdev", "pstdev", "nanstd", "var", "variance", "pvariance", "ptp"), SPREAD),
    **dict.fromkeys(("max", "amax"), "is the largest of the rates, their mean and the most noise"),
    **dict.fromkeys(("min", "amin"), "is the smallest of the rates, their mean and the most noise"),
}
SUMS = frozenset({"sum", "fsum", "nansum"})
DEPTH = 4  # steps in which a name is replaced by what it was assigned


def reads_rates(tree: ast.AST) -> Iterator[ast.FunctionDef]:
    """Yield the functions that read a turning rate."""
    for node in nodes_of(tree, ast.FunctionDef):
        if "angular_velocity" in unparse(node):
            yield node


def _sums(function: ast.FunctionDef) -> Iterator[tuple[ast.stmt, str, ast.expr]]:
    """Yield the statements that make an attribute of a rate: the statement, the attribute, and what is added."""
    values = assigned_once(function)
    for node in walk(function):
        target = node.targets[0] if isinstance(node, ast.Assign) else getattr(node, "target", None)
        if not isinstance(node, ast.Assign | ast.AugAssign) or not isinstance(target, ast.Attribute):
            continue
        name = unparse(target)
        text = unparse(expanded(node.value, values))
        if "angular_velocity" in text and not re.search("bias|offset|drift|mean|rates", name):
            yield node, name, node.value


def angle_sums(function: ast.FunctionDef) -> Iterator[tuple[ast.stmt, str, ast.expr, ast.expr]]:
    """Yield the statements that add to an attribute: the statement, the attribute, what is added, and its whole."""
    values = assigned_once(function)
    for node, name, value in _sums(function):
        if _adds(node, name):
            yield node, name, value, expanded(value, values)


def assigned_once(function: ast.FunctionDef) -> dict[str, ast.expr]:
    """Return what names of a function are assigned, if only once."""
    found: dict[str, list[ast.expr]] = {}
    for target, value in assigned(function):
        if isinstance(target, ast.Name):
            found.setdefault(target.id, []).append(value)
    return {name: values[0] for name, values in found.items() if len(values) == 1}


def expanded(value: ast.expr, values: dict[str, ast.expr], depth: int = DEPTH) -> ast.expr:
    """Return an expression with names replaced by what they were assigned."""

    class Replace(ast.NodeTransformer):
        def visit_Name(self, node: ast.Name) -> ast.expr:
            known = values.get(node.id) if depth else None
            return expanded(known, values, depth - 1) if known is not None else node

    return Replace().visit(ast.parse(unparse(value), mode="eval").body)


def _constants(tree: ast.AST) -> dict[str, float]:
    """Return the numbers that names in capitals, and attributes, are assigned once."""
    found: dict[str, list[object]] = {}
    for target, value in assigned(tree):
        number: object = value.value if isinstance(value, ast.Constant) else None
        if isinstance(value, ast.BinOp) and re.fullmatch(r"[\d.]+ / [\d.]+", unparse(value)):
            number = 1.0  # a quotient of two numbers, such as 1 / 25
        found.setdefault(unparse(target), []).append(number)
    return {
        name: float(values[0])
        for name, values in found.items()
        if len(values) == 1 and isinstance(values[0], int | float) and not isinstance(values[0], bool)
    }


@suspicion
def parts_of_times(tree: ast.AST) -> Iterator[Suspect]:
    """Find steps of a sum, and functions that return a time, in which a part of a stamp is taken for the whole."""
    for function in reads_rates(tree):
        values = assigned_once(function)
        for node, _, value in _sums(function):
            yield from _part_of_time(node.lineno, unparse(expanded(value, values)))
    whole = unparse(tree)
    for other in nodes_of(tree, ast.FunctionDef):
        if len(re.findall(rf"\b{other.name}\(", whole)) < 2:
            continue
        for each in nodes_of(other, ast.Return):
            if each.value is not None and not re.search(
                rf"\.(?:sec|nanosec)\b.*\b{other.name}\(|\b{other.name}\(.*\.(?:sec|nanosec)\b",
                whole.replace(unparse(other), ""),
            ):
                yield from _part_of_time(each.lineno, unparse(expanded(each.value, assigned_once(other))))


def _adds(node: ast.stmt, name: str) -> bool:
    """Say whether a statement adds to what an attribute was."""
    again = re.compile(rf"{re.escape(name)}\b")
    return isinstance(node, ast.AugAssign) or bool(isinstance(node, ast.Assign) and again.search(unparse(node.value)))


@suspicion_of(About.GYROSCOPE)
def rates_in_degrees(tree: ast.AST) -> Words:
    """Find a rate, or the sum of rates, that is converted from degrees."""
    for function in reads_rates(tree):
        values = assigned_once(function)
        names = {name for _, name, _ in _sums(function)}
        for node in walk(function):
            text = unparse(node) if isinstance(node, ast.Call | ast.BinOp) else ""
            given: ast.expr | None = None
            if isinstance(node, ast.Call) and last_name(node.func) in TO_RADIANS and node.args:
                given = node.args[0]
            elif isinstance(node, ast.BinOp) and BY_HAND.search(text) and not BY_HAND.search(unparse(node.left)):
                given = node.left
            if given is not None and _is_rate(expanded(given, values), names):
                yield (
                    getattr(node, "lineno", function.lineno),
                    f"{text[:60]} converts from degrees what is in radians already: angular_velocity is in rad/s, so "
                    "the heading grows 57 times too slowly",
                )
                break


@suspicion_of(About.GYROSCOPE)
def biases(tree: ast.AST) -> Words:
    """Find what is subtracted from the rates if it is made of the standing rates by something else than their mean."""
    lists = set(_lists_of_rates(tree))
    for function in reads_rates(tree):
        for _, _, value in _sums(function):
            made = _made_of(tree, value, lists)
            for part in (each for given in (*made, value) for each in walk(given)):
                words = _no_mean(part, lists)
                if words and (isinstance(part, ast.Call) or _subtracted(tree, part)):
                    yield (
                        getattr(part, "lineno", function.lineno),
                        f"{unparse(part)[:60]} {words}: the bias is their mean, what the gyroscope says on average "
                        "while the robot stands",
                    )


@suspicion_of(About.GYROSCOPE)
def signs(tree: ast.AST) -> Words:
    """Find rates, or times, that are added up with a wrong sign."""
    for function in reads_rates(tree):
        values = assigned_once(function)
        for node, name, value in _sums(function):
            if not _adds(node, name):
                continue
            whole = expanded(value, values)
            for each in nodes_of(whole, ast.BinOp):
                if not isinstance(each.op, ast.Sub):
                    continue
                left, right = unparse(each.left), unparse(each.right)
                if EARLIER.search(left) and not EARLIER.search(right) and "stamp" in right:
                    yield node, f"the time {unparse(each)[:60]} is negative: it is the later stamp minus the one before"
            sign = _sign(whole) * (-1 if isinstance(node, ast.AugAssign) and isinstance(node.op, ast.Sub) else 1)
            if sign < 0:
                yield (
                    node,
                    f"{unparse(node)[:70]} takes the rate with a minus sign: a turn to the left has a positive "
                    "rate and makes the heading larger",
                )


@suspicion_of(About.GYROSCOPE)
def wrong_fields(tree: ast.AST) -> Words:
    """Find another axis than z, and parts of stamps."""
    for function in reads_rates(tree):
        text = unparse(function)
        for node in walk(function):
            if isinstance(node, ast.Attribute) and unparse(node).endswith(("angular_velocity.x", "angular_velocity.y")):
                yield node, f"{unparse(node)} is tilting: turning on the spot is about z"
            if isinstance(node, ast.Call) and called(node) & {"degrees", "rad2deg"}:
                yield node, f"{unparse(node)[:60]} makes degrees, and a full turn is 2 pi"
        if ".nanosec" in text and not re.search(r"\.sec\b|from_msg", text):
            line = next(n.lineno for n in nodes_of(function, ast.Attribute) if n.attr == "nanosec")
            yield line, "stamp.nanosec begins again at 0 every second: the time is sec + nanosec / 1e9"
        if re.search(r"stamp\.sec\b", text) and ".nanosec" not in text:
            line = next(n.lineno for n in nodes_of(function, ast.Attribute) if n.attr == "sec")
            yield line, "stamp.sec are whole seconds only: the time is sec + nanosec / 1e9"
    for node in nodes_of(tree, ast.Call):
        if last_name(node.func) in SUMS and _undivided(tree, node):
            given = unparse(node)
            if re.search("rate|bias|gyro|still|offset|sample", given):
                yield node, f"{given[:60]} is a sum; the bias is the mean: divide by their number"


def _undivided(tree: ast.AST, call: ast.Call) -> bool:
    """Say whether a sum stands in no division, and is not given a name that might be divided later."""
    for node in nodes_of(tree, ast.BinOp):
        if isinstance(node.op, ast.Div) and any(e is call for e in walk(node.left)):
            return False
    return not any(value is call and isinstance(target, ast.Name) for target, value in assigned(tree))


@suspicion_of(About.GYROSCOPE)
def turns_of_360(tree: ast.AST) -> Words:
    """Find a heading that is compared with 360 where nothing makes degrees."""
    if called(tree) & {"degrees", "rad2deg"} or not any(reads_rates(tree)):
        return
    for node in nodes_of(tree, ast.Compare):
        numbers = [each.value for each in nodes_of(node, ast.Constant)]
        if any(each in (180, 360) for each in numbers) and re.search("heading|yaw|angle|turned", unparse(node)):
            yield node, f"{unparse(node)[:70]} compares radians with degrees: a full turn is 2 pi, not 360"


def _part_of_time(line: int, text: str) -> Iterator[Suspect]:
    seconds, rest = re.search(r"\.sec\b", text), ".nanosec" in text
    if re.search("from_msg|nanoseconds", text) or bool(seconds) == rest:
        return
    if rest:
        yield (
            line,
            About.GYROSCOPE,
            "the time is made of stamp.nanosec alone, which begins again at 0 every second: the time is sec + "
            "nanosec / 1e9",
        )
    else:
        yield (
            line,
            About.GYROSCOPE,
            "the time is made of stamp.sec alone, whole seconds: the time is sec + nanosec / 1e9",
        )


@suspicion_of(About.GYROSCOPE)
def fixed_times(tree: ast.AST) -> Words:
    """Find rates that are added up with the same time for every message, or without any."""
    constants = _constants(tree)
    for function in reads_rates(tree):
        values = assigned_once(function)
        for node, name, value in _sums(function):
            whole = expanded(value, values)
            names = {unparse(each) for each in nodes_of(whole, ast.Name, ast.Attribute)}
            others = [each for each in names if each not in constants and TIMES.search(each)]
            if others or not _adds(node, name) or f"{name} / " in unparse(tree):
                continue  # a sum that is divided is on its way to be a mean
            factors = [each for each in names if each in constants and each != name and "bias" not in each]
            numbers = [each.value for each in nodes_of(whole, ast.Constant) if each.value not in (0, 1)]
            if factors or numbers:
                yield (
                    node,
                    f"{unparse(node)[:70]} counts every message for the same time, which is not that between "
                    "two messages: use the difference of their stamps",
                )
            else:
                yield (
                    node,
                    f"{unparse(node)[:70]} adds rates [rad/s] without a time: an angle is a rate times the time "
                    "since the message before",
                )


def _is_rate(value: ast.expr, names: set[str]) -> bool:
    text = unparse(value)
    return "angular_velocity" in text or text in names


@suspicion_of(About.GYROSCOPE)
def replaced(tree: ast.AST) -> Words:
    for function in reads_rates(tree):
        for node, name, value in _sums(function):
            text = unparse(value)
            if re.search("heading|yaw|angle|turned|theta", name) and not _adds(node, name) and "*" in text:
                yield (
                    node,
                    f"{unparse(node)[:70]} forgets what was turned before: the steps are added up, {name} += ...",
                )


def _made_of(tree: ast.AST, value: ast.expr, lists: set[str]) -> list[ast.expr]:
    """Return what the names in an expression are assigned, and the names in that, some steps deep."""
    made: list[ast.expr] = []
    names, known = _names(value), set(lists)
    for _ in range(DEPTH):
        known |= names
        more = [given for target, given in assigned(tree) if unparse(target) in names - lists]
        made += more
        names = {name for given in more for name in _names(given)} - known
    return made


def _names(value: ast.expr) -> set[str]:
    return {unparse(each) for each in nodes_of(value, ast.Name, ast.Attribute)}


def _subtracted(tree: ast.AST, part: ast.AST) -> bool:
    """Say whether an expression is subtracted from something, or is called a bias."""
    return any(
        (isinstance(node, ast.BinOp) and isinstance(node.op, ast.Sub) and node.right is part) for node in walk(tree)
    ) or any(value is part and re.search("bias|offset|drift|zero", unparse(name)) for name, value in assigned(tree))


def _no_mean(part: ast.AST, lists: set[str]) -> str:
    """Return what a part of an expression is if it is made of a list of rates and is not their mean."""
    if isinstance(part, ast.Call):
        given = {unparse(each) for each in (*part.args, part.func) if isinstance(each, ast.Name | ast.Attribute)}
        return NO_MEANS.get(last_name(part.func), "") if given & lists else ""
    if isinstance(part, ast.Subscript) and not _sliced(part) and unparse(part.value) in lists:
        return "is a single one of the rates, with its noise"
    return ""


def _sliced(value: ast.Subscript) -> bool:
    return isinstance(value.slice, ast.Slice)


def _lists_of_rates(tree: ast.AST) -> Iterator[str]:
    """Yield the names of the lists to which rates are appended."""
    for function in reads_rates(tree):
        values = assigned_once(function)
        for node in nodes_of(function, ast.Call):
            if last_name(node.func) not in ("append", "appendleft") or not node.args:
                continue
            if "angular_velocity" in unparse(expanded(node.args[0], values)):
                yield unparse(node.func).rpartition(".")[0]


@suspicion_of(About.GYROSCOPE)
def jumps(tree: ast.AST) -> Words:
    """Find a heading that is brought back into one turn."""
    for function in reads_rates(tree):
        names = {name for _, name, _ in _sums(function)}
        for node in walk(function):
            target = node.targets[0] if isinstance(node, ast.Assign) else getattr(node, "target", None)
            if not isinstance(node, ast.Assign | ast.AugAssign) or target is None or unparse(target) not in names:
                continue
            wraps = bool(called(node.value) & WRAPS) or isinstance(getattr(node, "op", None), ast.Mod)
            wraps |= any(isinstance(each, ast.BinOp) and isinstance(each.op, ast.Mod) for each in walk(node.value))
            wraps |= isinstance(node, ast.AugAssign) and isinstance(node.op, ast.Sub) and "pi" in unparse(node.value)
            if wraps:
                yield (
                    node,
                    f"{unparse(node)[:70]} makes the heading jump back, so it never reaches a full turn, 2 pi: add "
                    "up without a limit",
                )


def _sign(value: ast.expr) -> int:
    """Return the sign with which an expression holds a turning rate; 0 if it holds none."""
    if "angular_velocity" not in unparse(value):
        return 0
    match value:
        case ast.UnaryOp(op=ast.USub(), operand=inner):
            return -_sign(inner)
        case ast.BinOp(left=left, op=ast.Sub(), right=right):
            return _sign(left) - _sign(right)
        case ast.BinOp(left=left, op=ast.Add() | ast.Mult() | ast.Div(), right=right):
            return _sign(left) + _sign(right)
    return 1
