"""Results that are lost: nothing is returned, or what was found is set back before it is sent."""

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

SENT = frozenset({"publish", "info"})
NEVER_RETURN = frozenset({"NotImplementedError", "abstractmethod"})


@slip
def search_of_another(tree: ast.AST) -> Iterator[Place]:
    """Find `if r < valid[0]: nearest = r` in a loop over valid, which compares with the first value, not the best."""
    for loop in (node for node in nodes_of(tree, ast.For) if isinstance(node.target, ast.Name)):
        first = f"{unparse(loop.iter)}[0]"
        for node in nodes_of(loop, ast.If):
            if not isinstance(node.test, ast.Compare):
                continue
            sides = {unparse(each) for each in (node.test.left, *node.test.comparators)}
            for target, value in (pair for each in node.body for pair in assigned(each)):
                if sides == {unparse(loop.target), first} and unparse(value) == unparse(loop.target):
                    yield (
                        node.lineno,
                        f"{unparse(node.test)} compares with the first value each time, so {unparse(target)} "
                        "becomes the last value that is better than the first; compare with the best so far",
                    )


def _constant(value: ast.expr) -> bool:
    """Return whether a value is a number, or infinity under one of its names."""
    if isinstance(value, ast.Constant) and isinstance(value.value, int | float):
        return True
    return unparse(value) in ("math.inf", "inf", "float('inf')", "np.inf", "numpy.inf", "-math.inf")


def _computes(statement: ast.stmt, name: str) -> bool:
    return any(unparse(target) == name and not _constant(value) for target, value in assigned(statement))


def _sends(statement: ast.stmt, name: str) -> int:
    """Return the line in which a statement by itself publishes or logs a name; 0 if it does not."""
    if not isinstance(statement, ast.Expr):
        return 0
    for call, what in calls(statement):
        if what in SENT and any(unparse(each) == name for given in _given(call) for each in walk(given)):
            return call.lineno
    return 0


def _given(call: ast.Call) -> list[ast.expr]:
    return [*call.args, *(each.value for each in call.keywords)]


@slip_of(ast.FunctionDef, first=True)
def before_it_is_sent(function: ast.FunctionDef) -> Words:
    """Find `self.nearest = math.inf` in every call, between the loop that finds it and the publish() of it."""
    for i, statement in enumerate(function.body):
        if not isinstance(statement, ast.Assign) or len(statement.targets) != 1 or not _constant(statement.value):
            continue
        name = unparse(statement.targets[0])
        if not any(_computes(each, name) for each in function.body[:i]):
            continue
        for later in function.body[i + 1 :]:
            if any(unparse(target) == name for target, _ in assigned(later)):
                break
            if line := _sends(later, name):
                yield (
                    statement,
                    f"{unparse(statement)[:60]} comes before line {line}, which sends {name}: what was found "
                    "is lost; set it back after that line, or at the beginning of the function",
                )


@slip_of(ast.For)
def else_of_a_search(loop: ast.For) -> Words:
    """Find `if r < best: best = r` in a loop whose else sets best to something that is not in the scan's own loop."""
    values = {node.id for node in nodes_of(loop.target, ast.Name)}
    for node in (each for each in nodes_of(loop, ast.If) if isinstance(each.test, ast.Compare)):
        sides = {unparse(each) for each in (node.test.left, *node.test.comparators)}  # type: ignore[attr-defined]
        kept = {
            unparse(target)
            for each in node.body
            for target, value in assigned(each)
            if {unparse(target), unparse(value)} == sides and unparse(value) in values
        }
        for each in node.orelse:
            for target, value in assigned(each) if isinstance(each, ast.Assign) else ():
                if unparse(target) in kept and not values & {unparse(part) for part in walk(value)}:
                    yield (
                        each,
                        f"{unparse(each)[:60]} forgets what was found as soon as one value is no better: only "
                        "the last ones count; a search needs no else",
                    )


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
