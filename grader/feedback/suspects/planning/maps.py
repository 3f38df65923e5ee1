"""Suspects in what a map shows: it forgets what it has seen, or asks for more than most cells are seen."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from typing import TypeGuard

from gz_course.grader.feedback.facts.constants import Number, named_numbers, number
from gz_course.grader.feedback.facts.syntax import Words, assigned, calls, functions, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About
from gz_course.grader.feedback.suspects.memory.callbacks import reached

FADES = 0.998  # a factor at which half is left after a minute or more
EMPTIES = frozenset({"clear", "fill"})
TAKEN_OUT = frozenset({"clear", "remove", "pop", "popleft"})
COUNTS = re.compile(r"hit|pass|free|miss|seen|count|visit|evidence|score|odds", re.IGNORECASE)
MANY = 10  # observations, after which a scanner has turned elsewhere


@suspicion_of(About.FORGETS)
def forgets(tree: ast.AST) -> Words:
    """Find an array or a dictionary that a callback makes anew each time as `__init__` did."""
    own = {node.name for node in nodes_of(tree, ast.ClassDef)}
    begun = {
        unparse(target): unparse(value)
        for one in functions(tree)
        if one.name == "__init__"
        for target, value in assigned(one)
        if unparse(target).startswith("self.") and (_holds_much(value) or _is_of(value, own))
    }
    parts = {unparse(node.value) for node in nodes_of(tree, ast.Subscript) if not isinstance(node.value, ast.Subscript)}
    for function in reached(tree):
        for statement in function.body:  # of its own, under no condition
            name = ""
            match statement:
                case ast.Assign(targets=[ast.Attribute() as target], value=value):
                    same = begun.get(unparse(target)) == unparse(value)
                    name = unparse(target) if same or _of_zeros(value, unparse(target)) else ""
                case ast.Expr(value=ast.Call(func=ast.Attribute(value=ast.Attribute() as whole, attr=method))):
                    name = unparse(whole) if method in EMPTIES else ""
                case ast.Assign(
                    targets=[ast.Subscript(value=ast.Attribute() as whole, slice=ast.Slice(None, None, None))],
                    value=ast.Constant() | ast.UnaryOp(),
                ):
                    name = unparse(whole)
            used = (
                name in parts
                or begun.get(name, "").partition("(")[0] in own
                or f"{name} = " in unparse(function).replace(unparse(statement), "")
            )
            if name in begun and used:
                yield (
                    statement,
                    f"{unparse(statement)[:60]} sets {name} back in each call of {function.name}, so all that was "
                    "seen before is forgotten: make it once, in __init__",
                )


@suspicion_of(About.FADES)
def fades(tree: ast.AST) -> Words:
    """Find an array all of which a callback makes smaller each time: `self.odds *= 0.97`."""
    known = named_numbers(tree)
    arrays = {unparse(one) for one, value in assigned(tree) if _holds_much(value)}
    for function in reached(tree):
        for node in walk(function):
            match node:
                case ast.AugAssign(target=ast.Attribute() as whole, op=ast.Mult(), value=factor):
                    given = number(factor, known)
                case ast.Assign(targets=[ast.Attribute() as whole], value=value):
                    given = next((each for each in _factors(value, unparse(whole), known)), None)
                case _:
                    continue
            name = unparse(whole)
            if name in arrays and given is not None and 0 < given < FADES:
                yield (
                    node,
                    f"{unparse(node)[:60]} multiplies all of {name} by {given:g} in each {function.name}, so "
                    "what is not seen again fades: change only the cells that are seen",
                )


@suspicion_of(About.FADES)
def short_memory(tree: ast.AST) -> Words:
    """Find a deque of a few scans, which a callback of scans fills and from which a map is drawn."""
    callbacks = set(re.findall(r"LaserScan, .*?self\.(\w+)", unparse(tree)))
    filled = {
        unparse(call.func.value)
        for function in functions(tree)
        for call, name in calls(function)
        if name == "append" and isinstance(call.func, ast.Attribute)
        if function.name in callbacks or re.search(r"scan", unparse(call.args[0] if call.args else call))
    }
    emptied = {unparse(call.func).rpartition(".")[0] for call, name in calls(tree) if name in TAKEN_OUT}
    looped = {unparse(each.iter) for each in nodes_of(tree, ast.For, ast.comprehension)}
    for target, value in assigned(tree):
        name = unparse(target)
        limit = next((each.value for each in getattr(value, "keywords", []) if each.arg == "maxlen"), None)
        if limit is not None and name in (filled & looped) - emptied:
            yield (
                target,
                f"{unparse(value)} keeps the last scans only ({unparse(limit)}), so the map forgets what was "
                "seen before: count the hits and passes of every scan once, and keep the counts",
            )


def _factors(value: ast.expr, name: str, known: dict[str, Number]) -> Iterator[Number]:
    for node in nodes_of(value, ast.BinOp):
        if isinstance(node.op, ast.Mult):
            for one, other in ((node.left, node.right), (node.right, node.left)):
                factor = number(one, known)
                if unparse(other) == name and factor is not None:
                    yield factor


def _holds_much(value: ast.expr) -> bool:
    """Return whether a value is an array, a long list or a dictionary."""
    if isinstance(value, ast.Call):
        return unparse(value.func).startswith(("np.", "numpy.")) or unparse(value) in ("dict()", "set()")
    long = isinstance(value, ast.BinOp) and isinstance(value.op, ast.Mult) and isinstance(value.left, ast.List)
    return long or isinstance(value, ast.Dict | ast.ListComp)


def _is_of(value: ast.expr, classes: set[str]) -> bool:
    """Return whether a value is made by a class of the file with arguments, as a map is with its size."""
    return isinstance(value, ast.Call) and unparse(value.func) in classes and bool(value.args or value.keywords)


def _of_zeros(value: ast.expr, name: str) -> bool:
    return unparse(value).endswith((f"zeros_like({name})", f"full_like({name}, -1)"))


@suspicion_of(About.THRESHOLD)
def many_observations(tree: ast.Module) -> Words:
    """Find `self.passes > 60`, by which a cell that was seen 60 times is still unknown."""
    if "OccupancyGrid" not in unparse(tree):
        return
    known = named_numbers(tree)
    for node in walk(tree):
        match node:
            case ast.Compare(left=counted, ops=[ast.Gt() | ast.GtE()], comparators=[limit]):
                pass
            case ast.Compare(left=limit, ops=[ast.Lt() | ast.LtE()], comparators=[counted]):
                pass
            case _:
                continue
        least, text = number(limit, known), unparse(counted)
        scanned = isinstance(counted, ast.Attribute | ast.Subscript) and COUNTS.search(text)
        if least is not None and least >= MANY and scanned and "len(" not in text:
            yield (
                node,
                f"{unparse(node)[:60]} asks for {least:g} observations of a cell, and most cells are seen less "
                "often: decide by which of hits and passes are more, from the first one on",
            )


@suspicion_of(About.ERASED)
def free_again(tree: ast.Module) -> Words:
    """Find `grid[hits > 0] = 100` before `grid[passes > 0] = 0`, where walls that rays have passed become free."""
    if "OccupancyGrid" not in unparse(tree):
        return
    for block in _blocks(tree):
        walls: dict[str, tuple[int, ast.expr]] = {}
        for statement in block:
            match statement:
                case ast.Assign(targets=[ast.Subscript(value=grid, slice=mask)], value=value):
                    shown = unparse(value).rpartition(".")[2]
                case _:
                    continue
            name = unparse(grid)
            if shown in ("100", "OCCUPIED"):
                walls[name] = statement.lineno, mask
            elif shown in ("0", "FREE") and name in walls:
                line, first = walls[name]
                if (
                    _alone(mask)
                    and isinstance(mask.comparators[0], ast.Constant)
                    and _alone(first)
                    and not _counted(mask) & _counted(first) - _counted(grid)
                ):
                    yield (
                        statement,
                        f"`{unparse(statement)[:70]}` comes after line {line}, `{unparse(first)[:50]}`, which "
                        "makes cells occupied: where both hold, as in walls that some ray has passed, the later one "
                        "counts, so they are free: exchange the two lines",
                    )


def _blocks(tree: ast.AST) -> Iterator[list[ast.stmt]]:
    for node in walk(tree):
        yield from (block for field in ("body", "orelse") if isinstance(block := getattr(node, field, None), list))


def _alone(mask: ast.expr) -> TypeGuard[ast.Compare]:
    """Return whether a mask is one condition on one kind of count."""
    return (
        isinstance(mask, ast.Compare) and len(mask.ops) == 1 and isinstance(mask.ops[0], ast.Gt | ast.GtE | ast.NotEq)
    )


def _counted(node: ast.expr) -> set[str]:
    """Return what is compared first in a mask."""
    left = node.left if isinstance(node, ast.Compare) else node
    names = nodes_of(left, ast.Attribute, ast.Name)
    return {unparse(each) for each in names} - {"self", "np"}
