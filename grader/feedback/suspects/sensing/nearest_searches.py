"""Suspects in the search for the nearest range of a scan, in nodes that steer: it keeps or drops the wrong one."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.constants import named_numbers, number
from gz_course.grader.feedback.facts.syntax import (
    Words,
    assigned,
    functions,
    last_name,
    left_early,
    nodes_of,
    unparse,
    walk,
)
from gz_course.grader.feedback.suspects import suspicion, suspicion_of
from gz_course.grader.feedback.suspects.about import About, Suspect

LEAST, MOST = 0.3, 2.5  # [m] ranges below and beyond which a node may leave out
WIDE_ENDS, WIDE = 2, 0.7  # limits of a sector, and how far apart they are at least [rad]
PARAMETER = re.compile(r"get_parameter\(['\"]distance['\"]\)\.value$")


def _steers(tree: ast.Module) -> bool:
    text = unparse(tree)
    return "angular.z" in text and ".ranges" in text


@suspicion_of(About.NEAREST_RANGE)
def kept_from_scan_to_scan(tree: ast.Module) -> Words:
    """Find a smallest range that is an attribute, and begins again with no scan."""
    if not _steers(tree):
        return
    stores: dict[str, list[tuple[str, ast.expr, ast.expr]]] = {}
    for function in functions(tree):
        for target, value in assigned(function):
            stores.setdefault(unparse(target), []).append((function.name, target, value))
    for function in functions(tree):
        for name, node in _smallest_so_far(function):
            others = [each for each in stores.get(name, []) if each[2] not in list(walk(node))]
            if name.startswith("self.") and others and all(each[0] == "__init__" for each in others):
                yield (
                    node,
                    f"{name} is the smallest range of all scans since the start, because nothing sets it back: begin "
                    "each scan with math.inf",
                )


@suspicion_of(About.NEAREST_RANGE)
def list_of_all_scans(tree: ast.Module) -> Words:
    """Find a list of ranges that is an attribute, grows in each scan, and is never emptied."""
    if not _steers(tree):
        return
    made = [(function.name, unparse(target), value) for function in functions(tree)
            for target, value in assigned(function)]  # fmt: skip
    text = unparse(tree)
    for name in {name for where, name, value in made if where == "__init__" and unparse(value) in ("[]", "list()")}:
        others = [where for where, other, _ in made if other == name and where != "__init__"]
        shortened = any(f"{name}.{each}" in text for each in ("clear", "pop", "remove")) or f"del {name}" in text
        if others or shortened or not name.startswith("self."):
            continue
        names = {name, *(other for _, other, value in made if unparse(value) == name)}
        for function in functions(tree):
            for loop in (node for node in nodes_of(function, ast.For) if _range_of(node)):
                for call in nodes_of(loop, ast.Call):
                    grown, _, what = unparse(call.func).rpartition(".")
                    if what == "append" and grown in names and function.name != "__init__":
                        yield (
                            call,
                            f"{unparse(call)[:60]} adds to {name}, which still holds the rays of all scans before: "
                            "nothing empties it, so begin each scan with an empty list",
                        )
                        return


def _smallest_so_far(function: ast.FunctionDef) -> Iterator[tuple[str, ast.stmt]]:
    """Yield each name that keeps the smaller of itself and another value, and the statement that does it."""
    for node in walk(function):
        match node:
            case ast.If(test=ast.Compare(left=left, ops=[ast.Lt() | ast.LtE()], comparators=[right])):
                value, name = unparse(left), unparse(right)
            case ast.If(test=ast.Compare(left=left, ops=[ast.Gt() | ast.GtE()], comparators=[right])):
                value, name = unparse(right), unparse(left)
            case ast.Assign(targets=[target], value=ast.Call(func=ast.Name(id="min"), args=[_, _] as args)):
                if unparse(target) in [unparse(each) for each in args]:
                    yield unparse(target), node
                continue
            case _:
                continue
        if any((unparse(target), unparse(given)) == (name, value) for target, given in assigned(node)):
            yield name, node


@suspicion_of(About.NEAREST_RANGE)
def ends_at_the_first(tree: ast.Module) -> Words:
    """Find a search that ends at the first range that is smaller than its beginning."""
    if not _steers(tree):
        return
    for function in functions(tree):
        found = {id(node): name for name, node in _smallest_so_far(function)}
        for node in walk(function):
            if id(node) in found and isinstance(node, ast.If) and isinstance(node.body[-1], ast.Break):
                name = found[id(node)]
                yield (
                    node.body[-1],
                    f"break ends the search at the first ray that sets {name}: all rays must be compared to find the "
                    "nearest, so remove it",
                )


@suspicion_of(About.NEAREST_RANGE)
def last_one(tree: ast.Module) -> Words:
    """Find a loop over the ranges that keeps each one in turn, and a use of what is left after it."""
    if not _steers(tree):
        return
    known = named_numbers(tree)
    for function in functions(tree):
        for loop in nodes_of(function, ast.For):
            kept = _range_of(loop)
            if not kept or left_early(loop):
                continue
            for target, value in assigned(loop):
                if not isinstance(target, ast.Name) or unparse(value) not in kept:
                    continue
                if not all(_is_wide(test, known) for test in _conditions(loop, target)):
                    continue  # one ray is chosen
                name = target.id
                used = {id(node) for node in walk(loop)}
                inside = any(_reads(node, name) for node in walk(loop))
                after = [
                    node for node in walk(function) if id(node) not in used and _reads(node, name)
                    and node.lineno > (loop.end_lineno or 0)  # type: ignore[attr-defined]
                ]  # fmt: skip
                if not inside and after and name not in kept:
                    yield (
                        target,
                        f"{name} = {unparse(value)} is done for each ray that is valid, so after the loop it is "
                        f"the last of them, not the nearest: do it only if {unparse(value)} < {name}",
                    )


def _conditions(loop: ast.For, target: ast.expr) -> Iterator[ast.expr]:
    for node in nodes_of(loop, ast.If):
        if any(each is target for each in walk(node)):
            yield node.test


def _is_wide(test: ast.expr, known: dict[str, int | float]) -> bool:
    """Say whether a condition surely holds for many rays: it asks whether they are valid, or for a wide sector."""
    for node in walk(test):
        if isinstance(node, ast.Call) and last_name(node.func) not in ("isfinite", "isinf", "isnan"):
            return False
        if isinstance(node, ast.Compare):
            sides = [node.left, *node.comparators]
            numbers = [value for each in sides if (value := number(each, known)) is not None]
            limits = any(isinstance(each, ast.Attribute) and each.attr.startswith("range_m") for each in sides)
            wide = len(numbers) == WIDE_ENDS and abs(numbers[0] - numbers[1]) > WIDE
            if any(isinstance(each, ast.Eq | ast.In) for each in node.ops) or not (limits or wide):
                return False
    return True


def _reads(node: ast.AST, name: str) -> bool:
    return isinstance(node, ast.Name) and node.id == name and isinstance(node.ctx, ast.Load)


def _range_of(loop: ast.For) -> set[str]:
    """Return the texts that mean the range of the ray in a loop over all of them; none if it is no such loop."""
    match loop.iter, loop.target:
        case ast.Attribute(attr="ranges"), ast.Name(id=name):
            return {name}
        case ast.Call(func=ast.Name(id="enumerate"), args=[given]), ast.Tuple(elts=[_, ast.Name(id=name)]):
            return {name} if unparse(given).endswith("ranges") else set()
        case ast.Call(func=ast.Name(id="range"), args=[given]), ast.Name(id=name) if "ranges" in unparse(given):
            texts = {f"{scan}ranges[{name}]" for scan in ("scan.", "msg.", "message.", "self.scan.", "data.", "")}
            own = {unparse(target) for target, value in assigned(loop) if unparse(value) in texts}
            return texts | own
    return set()


@suspicion
def left_out(tree: ast.Module) -> Iterator[Suspect]:
    """Find ranges that count only beyond, or only up to, a distance at which a wall may well be."""
    if not _steers(tree):
        return
    known = named_numbers(tree)
    parameters = {unparse(name) for name, value in assigned(tree) if PARAMETER.search(unparse(value))}
    for function in functions(tree):
        names = set().union(*(_range_of(loop) for loop in nodes_of(function, ast.For)))
        names |= _compared_arrays(function)
        for value, more, limit in _choices(function):
            if unparse(value) not in names:
                continue
            metres, text = number(limit, known), unparse(limit)
            wanted = text == "self.distance" or text in parameters
            near = more and (wanted if metres is None else LEAST < metres < MOST)
            if near or (not more and metres is not None and LEAST < metres < MOST):
                how = f"{text} = {metres:g} m" if metres is not None and not isinstance(limit, ast.Constant) else text
                yield (
                    limit.lineno,
                    About.LEFT_OUT_NEARER if near else About.LEFT_OUT_FARTHER,
                    f"ranges {'below' if near else 'beyond'} {how} are left out: a wall may well be there, so compare "
                    f"with {'range_min' if near else 'range_max'} of the scan",
                )


def _compared_arrays(function: ast.FunctionDef) -> set[str]:
    """Return the names of arrays of all ranges, and of the range in a comprehension."""
    found = set()
    for target, value in assigned(function):
        text = unparse(value)
        if isinstance(value, ast.Call) and last_name(value.func) in ("array", "asarray") and ".ranges" in text:
            found.add(unparse(target))
    for node in nodes_of(function, ast.comprehension):
        found |= _range_of(ast.For(target=node.target, iter=node.iter, body=[], orelse=[]))
    return found


def _choices(function: ast.FunctionDef) -> Iterator[tuple[ast.expr, bool, ast.expr]]:
    """Yield, for each comparison that chooses values, the value, whether it must be larger, and than what."""
    for node in walk(function):
        match node:
            case ast.Compare(ops=[_, _]):
                yield from _bounds(node)
            case ast.comprehension(ifs=tests):
                yield from (bound for test in tests for bound in _all_of(test))
            case ast.BinOp(op=ast.BitAnd()) | ast.BoolOp(op=ast.And()):
                yield from _all_of(node)
            case ast.If(test=test, body=[ast.Continue()]):
                yield from ((value, not more, limit) for value, more, limit in _all_of(test))
            case ast.If(test=test, body=[ast.Expr(value=ast.Call(func=ast.Attribute(attr="append")))]):
                yield from _all_of(test)


def _all_of(test: ast.expr) -> Iterator[tuple[ast.expr, bool, ast.expr]]:
    match test:
        case ast.BinOp(left=left, op=ast.BitAnd() | ast.BitOr(), right=right):
            yield from (*_all_of(left), *_all_of(right))
        case ast.BoolOp(values=values):
            yield from (bound for value in values for bound in _all_of(value))
        case ast.Compare():
            yield from _bounds(test)


def _bounds(node: ast.Compare) -> Iterator[tuple[ast.expr, bool, ast.expr]]:
    sides = [node.left, *node.comparators]
    for left, operation, right in zip(sides, node.ops, sides[1:], strict=False):
        if isinstance(operation, ast.Gt | ast.GtE | ast.Lt | ast.LtE):
            more = isinstance(operation, ast.Gt | ast.GtE)
            yield left, more, right
            yield right, not more, left
