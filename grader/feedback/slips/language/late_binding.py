"""Functions made in a loop that are called when the loop is over; used by the room of launch files.

Source: https://docs.python.org/3/faq/programming.html, "Why do lambdas defined in a loop with different values all
return the same result?"
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from gz_course.grader.feedback.facts.syntax import Place, children, nodes_of, unparse, walk
from gz_course.grader.feedback.slips import slip

Function = ast.Lambda | ast.FunctionDef
# What keeps a function that it is given, and calls it later. `sorted` and `map` call it at once.
LATER = frozenset({
    "OpaqueFunction", "OnProcessStart", "OnProcessExit", "OnProcessIO", "OnShutdown", "OnExecutionComplete",
    "create_subscription", "create_timer", "create_service", "add_done_callback", "add_on_set_parameters_callback",
    "registerCallback",
})  # fmt: skip
Comprehension = ast.ListComp | ast.GeneratorExp | ast.SetComp | ast.DictComp


@slip
def late_bound(tree: ast.AST) -> Iterator[Place]:
    """Find a function that reads the variable of a loop when the loop has given it its last value."""
    for loop in walk(tree):
        parts: Sequence[ast.AST]
        if isinstance(loop, ast.For):
            parts, bound = loop.body, _stored(loop.target)
            bound |= {name for part in parts for name in _stored(part)}
        elif isinstance(loop, Comprehension):
            parts = [loop.key, loop.value] if isinstance(loop, ast.DictComp) else [loop.elt]
            bound = {name for each in loop.generators for name in _stored(each.target)}
        else:
            continue
        if not any(isinstance(each, ast.Return | ast.Break) for part in parts for each in _own(part)):
            yield from _in_loop(parts, bound)


def _in_loop(parts: Sequence[ast.AST], bound: set[str]) -> Iterator[Place]:
    nodes = [each for part in parts for each in _own(part)]
    named = {each.name: each for each in nodes if isinstance(each, ast.FunctionDef)}
    for call in (each for each in nodes if isinstance(each, ast.Call)):
        if unparse(call.func).rpartition(".")[2] not in LATER:
            continue
        for given in [*call.args, *(each.value for each in call.keywords)]:
            function = named.get(given.id) if isinstance(given, ast.Name) else given
            if not isinstance(function, Function):
                continue
            free = sorted(_read(function) & bound - _own_names(function))
            if free:
                name, what = free[0], "lambda" if isinstance(function, ast.Lambda) else f"function {function.name}"
                written = [each.arg for each in function.args.args]
                head = ", ".join([*written, f"{name}={name}"])
                right = f"lambda {head}:" if isinstance(function, ast.Lambda) else f"def {function.name}({head})"
                yield (
                    function.lineno,
                    f"this {what} reads {name} when it is called, and the loop is over then: every one of them gets "
                    f"the last value of {name}. A default keeps the value of this iteration, {right}",
                )


def _own(part: ast.AST) -> Iterator[ast.AST]:
    """Yield the nodes of a part of a loop, without those inside of a function that is made there."""
    yield part
    if isinstance(part, ast.Lambda | ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
        return
    for child in children(part):
        yield from _own(child)


def _stored(part: ast.AST) -> set[str]:
    return {each.id for each in _own(part) if isinstance(each, ast.Name) and isinstance(each.ctx, ast.Store)}


def _read(function: Function) -> set[str]:
    body = function.body if isinstance(function.body, list) else [function.body]
    names = (each for part in body for each in nodes_of(part, ast.Name))
    return {each.id for each in names if isinstance(each.ctx, ast.Load)}


def _own_names(function: Function) -> set[str]:
    """Return the names that a function binds itself: its parameters, and what it assigns."""
    bound = {each.arg for each in nodes_of(function, ast.arg)}
    return bound | {each.id for each in nodes_of(function, ast.Name) if isinstance(each.ctx, ast.Store)}
