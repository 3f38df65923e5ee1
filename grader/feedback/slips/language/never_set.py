"""Attributes that are never set again: None for which a callback waits, a previous value that stays the first."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Place, is_none, nodes_of, unparse, walk
from gz_course.grader.feedback.slips import slip

Function = ast.FunctionDef | ast.AsyncFunctionDef
LEAVES = ast.Return | ast.Continue | ast.Raise
PREVIOUS = re.compile(r"(^|_)(last|prev|previous|old|before)(_|$)")


@slip
def waits_for_ever(tree: ast.AST) -> Iterator[Place]:
    """Find `if self.x is None: return` where nothing in the file sets `x` to anything else than None."""
    only_none, set_in = _values(tree)
    if any(isinstance(each, ast.Name) and each.id in ("setattr", "vars") for each in walk(tree)):
        return
    for function in _functions(tree):
        for test in (each for each in function.body if isinstance(each, ast.If)):
            if not isinstance(test.body[-1], LEAVES):
                continue
            for name in _asked_for_none(test.test):
                if name in only_none and function.name != "__init__":
                    yield (
                        test.lineno,
                        f"self.{name} is None for ever, so nothing below this line ever runs: no line sets self.{name} "
                        f"to anything else{_twice(set_in)}",
                    )


def _functions(tree: ast.AST) -> list[Function]:
    return [each for each in walk(tree) if isinstance(each, Function)]


def _values(tree: ast.AST) -> tuple[set[str], dict[str, list[str]]]:
    """Return the attributes that are only set to None, and the functions that set each other attribute."""
    none: dict[str, bool] = {}
    set_in: dict[str, list[str]] = {}
    for function in _functions(tree):
        for node in nodes_of(function, ast.Attribute):
            if not isinstance(node.ctx, ast.Store):
                continue
            made = next((each for each in walk(function) if _makes(each, node)), None)
            value = getattr(made, "value", None)
            nothing = isinstance(made, ast.Assign | ast.AnnAssign) and value is not None and is_none(value)
            none[node.attr] = none.get(node.attr, True) and nothing and function.name == "__init__"
            if function.name != "__init__":
                set_in.setdefault(node.attr, []).append(function.name)
    own = {id(each) for function in _functions(tree) for each in walk(function)}
    for node in nodes_of(tree, ast.Attribute):
        if isinstance(node.ctx, ast.Store):
            inside = id(node) in own and isinstance(node.value, ast.Name) and node.value.id == "self"
            none[node.attr] = none.get(node.attr, True) and inside
    return {name for name, only in none.items() if only}, set_in


def _makes(statement: ast.AST, target: ast.Attribute) -> bool:
    targets = statement.targets if isinstance(statement, ast.Assign) else [getattr(statement, "target", None)]
    return isinstance(statement, ast.Assign | ast.AnnAssign) and target in targets


def _asked_for_none(test: ast.expr) -> Iterator[str]:
    """Yield the attributes of self of which one that is None makes a condition true."""
    if isinstance(test, ast.BoolOp) and isinstance(test.op, ast.Or):
        for each in test.values:
            yield from _asked_for_none(each)
    elif isinstance(test, ast.Compare) and isinstance(test.ops[0], ast.Is) and is_none(test.comparators[0]):
        yield from _own(test.left)
    elif isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not):
        yield from _own(test.operand)


def _own(node: ast.expr) -> Iterator[str]:
    if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "self":
        yield node.attr


def _twice(set_in: dict[str, list[str]]) -> str:
    """Return that two functions set the same attribute, as a copied callback does; else nothing."""
    for name, names in set_in.items():
        if len(set(names)) == 2 and len(names) == 2:
            return f"; {names[0]} and {names[1]} both set self.{name}"
    return ""


@slip
def previous_stays(tree: ast.AST) -> Iterator[Place]:
    """Find `error - self.last_error` where nothing but `__init__` sets `last_error`, and it sets it to a number."""
    if any(isinstance(each, ast.Name) and each.id in ("setattr", "vars") for each in walk(tree)):
        return
    set_in: dict[str, list[str]] = {}
    first: dict[str, ast.expr] = {}
    for function in _functions(tree):
        for node in walk(function):
            if isinstance(node, ast.Attribute) and not isinstance(node.ctx, ast.Load):
                set_in.setdefault(node.attr, []).append(function.name)
            if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Attribute):
                first[node.targets[0].attr] = node.value
    for function in _functions(tree):
        for node in nodes_of(function, ast.BinOp):
            if not isinstance(node.op, ast.Sub) or function.name == "__init__":
                continue
            for name in _own(node.right):
                value = first.get(name)
                number = isinstance(value, ast.Constant) and type(value.value) in (int, float)
                if number and PREVIOUS.search(name) and set_in.get(name) == ["__init__"]:
                    yield (
                        node.lineno,
                        f"self.{name} stays {unparse(first[name])}, because only __init__ sets it, so "
                        f"{unparse(node)[:60]} is no change: set it to the new value at the end of each call",
                    )
