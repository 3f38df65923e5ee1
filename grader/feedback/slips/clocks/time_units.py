"""Times in the wrong unit: nanoseconds or minutes for seconds, and the parts of a stamp put together wrongly.

The unit of an expression is followed through names, attributes of self, sums, and products with numbers.
"""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Iterator, Mapping

from gz_course.grader.feedback.facts.constants import Number, named_numbers, number
from gz_course.grader.feedback.facts.syntax import Place, Words, last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.slips import slip, slip_of

BEFORE = ("no_effect", "callbacks")

UNITS = {1e-9: "nanoseconds", 1e-6: "microseconds", 1e-3: "milliseconds", 1.0: "seconds", 60.0: "minutes"}
SHORTEST = 0.02  # [s] a shorter time, written in another unit than seconds, is compared with by mistake
LONGEST = 200.0  # [s] so is a longer one: no run takes that long
WALL = frozenset({"time.time", "time.monotonic", "time.perf_counter"})
START = re.compile(r"(?:start|begin|first|t0|t_0)(?:_?time|ed|_?at)?$")
STEPS = 8  # names followed at most
HOLDS = ">= holds from then on"


@slip_of(ast.Compare)
def parts_of_a_second(node: ast.Compare, tree: ast.AST) -> Words:
    """Find the nanoseconds within a second compared with a whole second or more, which they never reach."""
    numbers = named_numbers(tree)
    if len(node.ops) != 1:
        return
    limit = number(node.comparators[0], numbers)
    within = last_name(node.left) == "nanosec" or unparse(node.left).endswith("seconds_nanoseconds()[1]")
    if within and limit is not None and limit >= 1e9:
        yield (
            f"{unparse(node)[:70]}: these are the nanoseconds within the current second, always less than "
            "1e9: the whole time is sec + nanosec / 1e9, or Time.nanoseconds"
        )


@slip
def sums_of_parts(tree: ast.AST) -> Iterator[Place]:
    """Find a sum of seconds and nanoseconds in which the second part has another unit than the first."""
    numbers, names = named_numbers(tree), _names_of_parts(tree)
    for node in nodes_of(tree, ast.BinOp):
        if not isinstance(node.op, ast.Add):
            continue
        for one, other in ((node.left, node.right), (node.right, node.left)):
            whole, part = _factor(one, "sec", names, numbers), _factor(other, "nanosec", names, numbers)
            if whole and part and not math.isclose(part / whole, 1e-9, rel_tol=1e-6):
                yield (
                    node.lineno,
                    f"{unparse(node)[:80]}: a nanosecond is 1e-9 s, and here it counts as {part / whole:g} s: "
                    "sec + nanosec * 1e-9 are seconds; Time.from_msg(stamp) takes both",
                )
                return


def _names_of_parts(tree: ast.AST) -> dict[str, str]:
    """Return which part of a time a name holds, for those that take the two of `seconds_nanoseconds()`."""
    names: dict[str, str] = {}
    for node in walk(tree):
        match node:
            case ast.Assign(
                targets=[ast.Tuple(elts=[one, other])],
                value=ast.Call(func=ast.Attribute(attr="seconds_nanoseconds")),
            ):
                names |= {unparse(one): "sec", unparse(other): "nanosec"}
    return names


def _factor(node: ast.expr, part: str, names: Mapping[str, str], numbers: Mapping[str, Number]) -> float | None:
    """Return the number by which a part of a time is multiplied; None if an expression is not that part alone."""
    match node:
        case ast.Attribute() | ast.Name():
            return 1.0 if names.get(unparse(node), last_name(node)) == part else None
        case ast.Call(func=ast.Name(id="int" | "float" | "round"), args=[inner]):
            return _factor(inner, part, names, numbers)
        case ast.BinOp(left=left, op=ast.Mult(), right=right):
            for one, other in ((left, right), (right, left)):
                inner_factor, factor = _factor(one, part, names, numbers), number(other, numbers)
                if inner_factor and factor:
                    return inner_factor * factor
        case ast.BinOp(left=left, op=ast.Div() | ast.FloorDiv(), right=right):
            inner_factor, factor = _factor(left, part, names, numbers), number(right, numbers)
            return inner_factor / factor if inner_factor and factor else None
    return None


@slip
def nanoseconds_alone(tree: ast.AST) -> Iterator[Place]:
    """Find the nanoseconds of a stamp used as its time, in a file that reads the seconds nowhere."""
    names = {last_name(node) for node in nodes_of(tree, ast.Attribute)}
    if names & {"sec", "seconds_nanoseconds"}:
        return
    copied = {id(node.value) for node in nodes_of(tree, ast.Assign) if last_name(node.targets[0]) == "nanosec"}
    for node in walk(tree):
        read = isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Load) and node.attr == "nanosec"
        if read and id(node) not in copied:
            yield (
                node.lineno,  # type: ignore[attr-defined]
                f"{unparse(node)[:70]} is the part of the time within a second, which begins at 0 again each "
                "second, and sec is read nowhere: Time.from_msg(stamp).nanoseconds is the whole time",
            )
            return


@slip
def wrong_units(tree: ast.AST) -> Iterator[Place]:
    """Find comparisons of a time with a number that is no usual time in the unit of the former."""
    numbers = named_numbers(tree)
    values = _values(tree)
    for node in nodes_of(tree, ast.Compare):
        if len(node.ops) != 1:
            continue
        if isinstance(node.ops[0], ast.Eq) and _lasts(node.left, values) != _lasts(node.comparators[0], values):
            code = unparse(node)[:70]
            yield node.lineno, f"{code}: a time is hardly ever exactly this one when it is looked at; {HOLDS}"
        for one, other in ((node.left, node.comparators[0]), (node.comparators[0], node.left)):
            unit, limit = _unit(one, values, numbers, STEPS), number(other, numbers)
            if unit is None or not limit or isinstance(node.ops[0], ast.Is | ast.IsNot | ast.NotEq):
                continue
            seconds = abs(limit) * unit
            if math.isclose(unit, 1.0) and seconds > LONGEST and _is_age(one, values, STEPS):
                continue  # a limit that no age exceeds has no wrong unit
            code = unparse(node)[:70]
            if isinstance(node.ops[0], ast.Eq):
                yield (
                    node.lineno,
                    f"{code}: a time is hardly ever exactly this number when it is looked at; {HOLDS}",
                )
            elif seconds > LONGEST or not _name(unit) or (seconds < SHORTEST and not math.isclose(unit, 1.0)):
                yield node.lineno, f"{code}: {_said(unit, limit, seconds)}"
    yield from _durations(tree, numbers)


def _is_age(node: ast.expr, values: Mapping[str, list[ast.expr]], steps: int) -> bool:
    """Return whether a time is the age of a message, which is reckoned from a stamp."""
    parts = [each for each in nodes_of(node, ast.Name, ast.Attribute)]
    if any(isinstance(each, ast.Attribute) and each.attr == "stamp" for each in parts):
        return True
    known = {unparse(each) for each in parts} & values.keys() if steps else set()
    return any(_is_age(value, values, steps - 1) for name in known for value in values[name])


def _lasts(node: ast.expr, values: Mapping[str, list[ast.expr]]) -> bool:
    """Return whether an expression is a Duration that is not 0, or the name of one."""
    given = values.get(unparse(node), []) if isinstance(node, ast.Name | ast.Attribute) else [node]
    return len(given) == 1 and (
        isinstance(given[0], ast.Call)
        and unparse(given[0].func).rpartition(".")[2] == "Duration"
        and any(number(each.value, {}) for each in given[0].keywords)
    )


def _name(unit: float) -> str:
    return next((name for each, name in UNITS.items() if math.isclose(each, unit, rel_tol=1e-6)), "")


def _said(unit: float, limit: Number, seconds: float) -> str:
    name = _name(unit)
    left = f"the left side is in {name}" if name else f"the unit of the left side is {unit:g} s"
    right = f"{abs(limit):g} of them are {seconds:g} s" if name != "seconds" else f"{abs(limit):g} s are waited for"
    return f"{left}, and {right}; nanoseconds / 1e9 are seconds"


def _durations(tree: ast.AST, numbers: Mapping[str, Number]) -> Iterator[Place]:
    for node in nodes_of(tree, ast.Call):
        if unparse(node.func).rpartition(".")[2] != "Duration":
            continue
        seconds = 0.0
        for each in node.keywords:
            value = number(each.value, numbers)
            if value is None or each.arg not in ("seconds", "nanoseconds", "sec", "nanosec"):
                break
            seconds += value * (1e-9 if each.arg.startswith("nano") else 1.0)
        else:
            if abs(seconds) > LONGEST or 1e-9 < abs(seconds) < 1e-6:
                yield node.lineno, f"{unparse(node)} lasts {seconds:g} s: 5 s are Duration(seconds=5)"


@slip
def negative_times(tree: ast.AST) -> Iterator[Place]:
    """Find `start - now`, which is negative and so always less than any limit."""
    values = _values(tree)
    fresh = {name: given for name, given in values.items() if not name.startswith("self.")}
    inside_abs = {
        id(inner)
        for node in nodes_of(tree, ast.Call)
        if unparse(node.func).rpartition(".")[2] in ("abs", "fabs")
        for inner in walk(node)
    }
    for node in nodes_of(tree, ast.BinOp):
        if not isinstance(node.op, ast.Sub) or id(node) in inside_abs:
            continue
        left, right = unparse(node.left), unparse(node.right)
        now = right.endswith(".now()") or [unparse(each)[-6:] for each in values.get(right, [])] == [".now()"]
        kept = left.startswith("self.") and _was_read(node.left, values, STEPS)
        if (START.search(left) and now) or (kept and not START.search(right) and _was_read(node.right, fresh, STEPS)):
            yield (
                node.lineno,
                f"{left} - {right} is negative, because {right} is the later one: the time that has passed is "
                f"{right} - {left}",
            )


@slip
def times_as_numbers(tree: ast.AST) -> Iterator[Place]:
    """Find a Time that is asked whether it equals a number, which it never does."""
    numbers, values = named_numbers(tree), _values(tree)
    for node in nodes_of(tree, ast.Compare):
        if not isinstance(node.ops[0], ast.Eq | ast.NotEq):
            continue
        code = unparse(node.left)
        now = code.endswith("get_clock().now()") or [
            unparse(each).endswith("get_clock().now()") for each in values.get(code, [])
        ] == [True]
        if now and number(node.comparators[0], numbers) is not None:
            yield (
                node.lineno,
                f"{unparse(node)[:70]}: {code} is a Time and never equal to a number: the seconds that have passed "
                "are (now - start).nanoseconds / 1e9, and >= holds from a moment on",
            )


def _was_read(node: ast.expr, values: Mapping[str, list[ast.expr]], steps: int) -> bool:
    """Return whether a time is what a clock said, in whatever unit, and no time was added to it or taken from it."""
    if steps <= 0:
        return False

    def again(each: ast.expr) -> bool:
        return _was_read(each, values, steps - 1)

    match node:
        case ast.Call(func=ast.Attribute(attr="now")):
            return True
        case (
            ast.Call(func=ast.Attribute(attr="to_msg", value=of))
            | ast.Attribute(attr="nanoseconds" | "sec" | "nanosec", value=of)
        ):
            return again(of)
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            return again(left) and again(right)
        case ast.BinOp(left=left, op=ast.Mult() | ast.Div() | ast.FloorDiv()):
            return again(left)
        case ast.Call(func=ast.Attribute(attr=name) | ast.Name(id=name)) if values.get(f"{name}()"):
            return all(again(each) for each in values[f"{name}()"])
        case ast.Name() | ast.Attribute():
            given = [each for each in values.get(unparse(node), []) if number(each, {}) is None]
            given = [each for each in given if not _nothing(each)]
            return bool(given) and all(again(each) for each in given)
    return False


def _values(tree: ast.AST) -> dict[str, list[ast.expr]]:
    """Return what is assigned to each name and attribute; the results of functions by `name()`."""
    found: dict[str, list[ast.expr]] = {}
    for node in walk(tree):
        if isinstance(node, ast.Assign) and len(node.targets) == 1:
            found.setdefault(unparse(node.targets[0]), []).append(node.value)
        elif isinstance(node, ast.AnnAssign | ast.NamedExpr) and node.value is not None:
            found.setdefault(unparse(node.target), []).append(node.value)
        elif isinstance(node, ast.FunctionDef):
            returned = [each.value for each in nodes_of(node, ast.Return) if each.value is not None]
            found.setdefault(f"{node.name}()", []).extend(returned)
    return found


def unit_of(node: ast.expr, values: dict[str, list[ast.expr]], numbers: Mapping[str, Number]) -> float | None:
    """Return the unit [s] of an expression, rounded to that of a name; None if it is unknown."""
    unit = _unit(node, values, numbers, STEPS)
    return None if unit is None else next((each for each in UNITS if math.isclose(each, unit, rel_tol=1e-6)), unit)


def _unit(node: ast.expr, values: dict[str, list[ast.expr]], numbers: Mapping[str, Number], steps: int) -> float | None:
    """Return the unit [s] of an expression that is a number of time units; None if it is unknown."""
    if steps <= 0:
        return None

    def again(each: ast.expr) -> float | None:
        return _unit(each, values, numbers, steps - 1)

    match node:
        case ast.Attribute(attr="nanoseconds"):
            return 1e-9
        case ast.Call(func=func) if unparse(func) in WALL:
            return 1.0
        case ast.Call(func=ast.Name(id="int" | "float" | "abs" | "round"), args=[inner, *_]):
            return again(inner)
        case ast.Call(func=ast.Attribute(attr=name) | ast.Name(id=name)) if f"{name}()" in values:
            return _common([again(each) for each in values[f"{name}()"]])
        case ast.BinOp(left=left, op=ast.Add() | ast.Sub(), right=right):
            units = [again(left), again(right)]
            return _common(units) if None not in units else None
        case ast.BinOp(left=left, op=ast.Div() | ast.FloorDiv(), right=right):
            unit, factor = again(left), number(right, numbers)
            return unit * factor if unit is not None and factor else None
        case ast.BinOp(left=left, op=ast.Mult(), right=right):
            for one, other in ((left, right), (right, left)):
                unit, factor = again(one), number(other, numbers)
                if unit is not None and factor:
                    return unit / factor
            return None
        case ast.Name() | ast.Attribute():
            assigned = [each for each in values.get(unparse(node), []) if not _nothing(each)]
            return _common([again(each) for each in assigned])
    return None


def _nothing(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and node.value in (None, 0)


def _common(units: list[float | None]) -> float | None:
    """Return the unit if all are equal and known."""
    first = units[0] if units else None
    return first if first is not None and all(u is not None and math.isclose(u, first) for u in units) else None
