"""Suspects in what is set back to its beginning while the node runs, although things are collected in it."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.constants import Number, named_numbers, number
from gz_course.grader.feedback.facts.syntax import Suspect, assigned, calls, functions, walk
from gz_course.grader.feedback.suspects.steering.sleeps import reached

FADES = 0.998  # a factor at which half is left after a minute or more
EMPTIES = frozenset({"clear", "fill"})
TAKEN_OUT = frozenset({"clear", "remove", "pop", "popleft"})


def forgets(tree: ast.AST) -> Iterator[Suspect]:
    """Find an array or a dictionary that a callback makes anew each time as `__init__` did."""
    own = {node.name for node in walk(tree) if isinstance(node, ast.ClassDef)}
    begun = {
        ast.unparse(target): ast.unparse(value)
        for one in functions(tree)
        if one.name == "__init__"
        for target, value in assigned(one)
        if ast.unparse(target).startswith("self.") and (_holds_much(value) or _is_of(value, own))
    }
    parts = {
        ast.unparse(node.value)
        for node in walk(tree)
        if isinstance(node, ast.Subscript) and not isinstance(node.value, ast.Subscript)
    }
    for function in reached(tree):
        for statement in function.body:  # of its own, under no condition
            name = ""
            match statement:
                case ast.Assign(targets=[ast.Attribute() as target], value=value):
                    same = begun.get(ast.unparse(target)) == ast.unparse(value)
                    name = ast.unparse(target) if same or _of_zeros(value, ast.unparse(target)) else ""
                case ast.Expr(value=ast.Call(func=ast.Attribute(value=ast.Attribute() as whole, attr=method))):
                    name = ast.unparse(whole) if method in EMPTIES else ""
                case ast.Assign(
                    targets=[ast.Subscript(value=ast.Attribute() as whole, slice=ast.Slice(None, None, None))],
                    value=ast.Constant() | ast.UnaryOp(),
                ):
                    name = ast.unparse(whole)
            used = (
                name in parts
                or begun.get(name, "").partition("(")[0] in own
                or f"{name} = " in ast.unparse(function).replace(ast.unparse(statement), "")
            )
            if name in begun and used:
                yield (
                    statement.lineno,
                    "forgets",
                    f"{ast.unparse(statement)[:60]} sets {name} back in each call of {function.name}, so all that was "
                    "seen before is forgotten: make it once, in __init__",
                )


def fades(tree: ast.AST) -> Iterator[Suspect]:
    """Find an array all of which a callback makes smaller each time: `self.odds *= 0.97`."""
    known = named_numbers(tree)
    arrays = {ast.unparse(one) for one, value in assigned(tree) if _holds_much(value)}
    for function in reached(tree):
        for node in walk(function):
            match node:
                case ast.AugAssign(target=ast.Attribute() as whole, op=ast.Mult(), value=factor):
                    given = number(factor, known)
                case ast.Assign(targets=[ast.Attribute() as whole], value=value):
                    given = next((each for each in _factors(value, ast.unparse(whole), known)), None)
                case _:
                    continue
            name = ast.unparse(whole)
            if name in arrays and given is not None and 0 < given < FADES:
                yield (
                    node.lineno,
                    "fades",
                    f"{ast.unparse(node)[:60]} multiplies all of {name} by {given:g} in each {function.name}, so "
                    "what is not seen again fades: change only the cells that are seen",
                )


def short_memory(tree: ast.AST) -> Iterator[Suspect]:
    """Find a deque of a few scans, which a callback of scans fills and from which a map is drawn."""
    callbacks = set(re.findall(r"LaserScan, .*?self\.(\w+)", ast.unparse(tree)))
    filled = {
        ast.unparse(call.func.value)
        for function in functions(tree)
        for call, name in calls(function)
        if name == "append" and isinstance(call.func, ast.Attribute)
        if function.name in callbacks or re.search(r"scan", ast.unparse(call.args[0] if call.args else call))
    }
    emptied = {ast.unparse(call.func).rpartition(".")[0] for call, name in calls(tree) if name in TAKEN_OUT}
    looped = {ast.unparse(each.iter) for each in walk(tree) if isinstance(each, ast.For | ast.comprehension)}
    for target, value in assigned(tree):
        name = ast.unparse(target)
        limit = next((each.value for each in getattr(value, "keywords", []) if each.arg == "maxlen"), None)
        if limit is not None and name in (filled & looped) - emptied:
            yield (
                target.lineno,
                "fades",
                f"{ast.unparse(value)} keeps the last scans only ({ast.unparse(limit)}), so the map forgets what was "
                "seen before: count the hits and passes of every scan once, and keep the counts",
            )


def _factors(value: ast.expr, name: str, known: dict[str, Number]) -> Iterator[Number]:
    for node in walk(value):
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult):
            for one, other in ((node.left, node.right), (node.right, node.left)):
                factor = number(one, known)
                if ast.unparse(other) == name and factor is not None:
                    yield factor


def _holds_much(value: ast.expr) -> bool:
    """Return whether a value is an array, a long list or a dictionary."""
    if isinstance(value, ast.Call):
        return ast.unparse(value.func).startswith(("np.", "numpy.")) or ast.unparse(value) in ("dict()", "set()")
    long = isinstance(value, ast.BinOp) and isinstance(value.op, ast.Mult) and isinstance(value.left, ast.List)
    return long or isinstance(value, ast.Dict | ast.ListComp)


def _is_of(value: ast.expr, classes: set[str]) -> bool:
    """Return whether a value is made by a class of the file with arguments, as a map is with its size."""
    return isinstance(value, ast.Call) and ast.unparse(value.func) in classes and bool(value.args or value.keywords)


def _of_zeros(value: ast.expr, name: str) -> bool:
    return ast.unparse(value).endswith((f"zeros_like({name})", f"full_like({name}, -1)"))


LOOKS = (forgets, fades, short_memory)
