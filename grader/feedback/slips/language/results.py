"""Functions that return nothing although their result is used, and one object under two names."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import (
    Place,
    Words,
    assigned,
    calls,
    functions,
    is_none,
    nodes_of,
    set_to,
    unparse,
    walk,
)
from gz_course.grader.feedback.slips import slip, slip_of

NEVER_RETURN = frozenset({"NotImplementedError", "abstractmethod"})


@slip
def no_return(tree: ast.AST) -> Iterator[Place]:
    """Find `if self.over():` where the function over has no return with a value."""
    own: dict[str, list[ast.FunctionDef]] = {}
    for function in functions(tree):
        own.setdefault(function.name, []).append(function)
    inner = {
        id(each)
        for function in functions(tree)
        for node in nodes_of(function, ast.FunctionDef, ast.Lambda, ast.AsyncFunctionDef)
        if node is not function
        for each in walk(node)
    }
    empty = {
        name: found[0]
        for name, found in own.items()
        if len(found) == 1 and not found[0].decorator_list and not _gives_something(found[0], inner)
    }
    for used in _used(tree):
        match used:
            case ast.Call(func=ast.Name(id=name) | ast.Attribute(value=ast.Name(id="self"), attr=name)) if (
                name in empty
            ):
                yield (
                    empty[name].lineno,
                    f"{name} returns nothing, so {unparse(used)[:40]} in line {used.lineno} is None: return "
                    "gives the result back",
                )
                return


def _gives_something(function: ast.FunctionDef, inner: set[int]) -> bool:
    text = unparse(function)
    if any(word in text for word in NEVER_RETURN):
        return True
    return any(
        isinstance(node, ast.Yield | ast.YieldFrom)
        or (
            isinstance(node, ast.Return) and node.value is not None and (id(node) not in inner or id(function) in inner)
        )
        for node in walk(function)
    )


def _used(tree: ast.AST) -> Iterator[ast.expr]:
    """Yield the expressions of which a value is wanted: conditions, terms, sides of comparisons, what is published."""
    done = {id(each.body if isinstance(each, ast.Lambda) else each.value)
            for each in nodes_of(tree, ast.Lambda, ast.Expr)}  # fmt: skip
    for node in walk(tree):
        match node:
            case ast.BoolOp(values=values) if id(node) in done:
                yield from values[:-1]  # `lambda: self.scan and self.answer()` calls it, and wants no value
            case ast.If(test=test) | ast.While(test=test) | ast.IfExp(test=test) | ast.UnaryOp(operand=test):
                yield test
            case ast.BoolOp(values=values):
                yield from values
            case ast.Compare(left=left, comparators=others) if not any(is_none(each) for each in others):
                yield from (left, *others)
            case ast.BinOp(left=left, right=right):
                yield from (left, right)
            case ast.Call(func=ast.Attribute(attr="publish"), args=[given]):
                yield given


@slip
def one_message(tree: ast.AST) -> Iterator[Place]:
    """Find `self.halt = self.go` and then fields of self.halt that are set, where both are published."""
    values = set_to(tree)
    sent = {unparse(call.args[0]) for call, name in calls(tree) if name == "publish" and call.args}
    for target, value in assigned(tree):
        name, other = unparse(target), unparse(value)
        if not isinstance(value, ast.Name | ast.Attribute):
            continue
        if (
            not {name, other} <= sent
            or len(values[name]) != 1
            or not isinstance(values.get(other, [value])[0], ast.Call)
        ):
            continue
        for field, _ in assigned(tree):
            if unparse(field).startswith(f"{name}.") and field.lineno > target.lineno:
                yield (
                    target.lineno,
                    f"{name} = {other} makes no second message: both names are the same one, and line {field.lineno} "
                    "changes it for both; make a new message for each",
                )
                return


@slip_of(ast.ClassDef, first=True)
def not_called(owner: ast.ClassDef) -> Words:
    """Find `if not self.over:` where over is a method: without brackets it is always true."""
    methods = {each.name for each in owner.body if isinstance(each, ast.FunctionDef) and not each.decorator_list}
    kept = {unparse(target) for target, _ in assigned(owner)}
    for node in walk(owner):
        match node:
            case ast.If(test=test) | ast.While(test=test) | ast.IfExp(test=test) | ast.UnaryOp(ast.Not(), test):
                parts = [test]
            case ast.BoolOp(values=[*parts, _]):  # the last one may be a value, as in `given or self.method`
                pass
            case ast.Compare(left=test, comparators=[ast.Constant(value=True | False)]):
                parts = [test]
            case _:
                continue
        for part in parts:
            name = unparse(part)
            if isinstance(part, ast.Attribute) and name.removeprefix("self.") in methods and name not in kept:
                yield (
                    part,
                    f"{name} without brackets is the method itself, which counts as true and is not called: {name}()",
                )
