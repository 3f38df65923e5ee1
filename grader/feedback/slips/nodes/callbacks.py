"""Callbacks that are passed wrongly: called at once, named inside of a lambda that does not call them."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Place, nodes_of, unparse
from gz_course.grader.feedback.slips import slip

# Method -> position of its callback.
CREATE = {
    "create_timer": 1, "create_subscription": 2, "create_service": 2, "add_on_set_parameters_callback": 0,
    "add_done_callback": 0, "registerCallback": 0, "ActionServer": 3,
}  # fmt: skip


def handed_over(tree: ast.AST) -> Iterator[tuple[ast.Call, ast.expr]]:
    """Yield each call that takes a callback, with the callback."""
    for node in nodes_of(tree, ast.Call):
        place = CREATE.get(unparse(node.func).rpartition(".")[2])
        if place is None:
            continue
        named = [each.value for each in node.keywords if each.arg in ("callback", "execute_callback")]
        if given := named or node.args[place : place + 1]:
            yield node, given[0]


@slip
def called_at_once(tree: ast.AST) -> Iterator[Place]:
    """Find a callback that is called where it should be passed."""
    functions = {node.name: node for node in nodes_of(tree, ast.FunctionDef, ast.AsyncFunctionDef)}
    for call, given in handed_over(tree):
        if not isinstance(given, ast.Call):
            continue
        function = unparse(given.func)
        own = functions.get(function.rpartition(".")[2])
        if own is not None and _returns_something(own):
            continue  # it may well return a function
        if not given.args and (function.startswith("self.") or isinstance(given.func, ast.Name)):
            yield (
                call.lineno,
                f"{function}() calls the function at once and passes on what it returns; the callback itself is "
                f"{function}, without brackets",
            )
        elif own is not None or function.endswith(".publish"):
            yield (
                call.lineno,
                f"{unparse(given)[:60]} is called at once, and its result, None, is passed as the callback: "
                f"lambda: {unparse(given)[:60]} is called later",
            )


def _returns_something(function: ast.FunctionDef | ast.AsyncFunctionDef) -> bool:
    returned = [node for node in nodes_of(function, ast.Return)]
    return any(node.value is not None and unparse(node.value) != "None" for node in returned)


@slip
def not_called_in_a_lambda(tree: ast.AST) -> Iterator[Place]:
    """Find `lambda: self.tick`, which names the function and does not call it."""
    for _, given in handed_over(tree):
        if isinstance(given, ast.Lambda) and isinstance(given.body, ast.Attribute | ast.Name):
            name = unparse(given.body)
            yield (
                given.lineno,
                f"{unparse(given)} names {name} and does not call it: pass {name} itself, or write lambda: {name}()",
            )


@slip
def texts_for_callbacks(tree: ast.AST) -> Iterator[Place]:
    """Find the name of a function in quotes, or None, where the function belongs."""
    for call, given in handed_over(tree):
        if isinstance(given, ast.Constant) and (given.value is None or isinstance(given.value, str)):
            value = unparse(given)
            yield call.lineno, f"{value} is given where the callback is needed: pass the function itself, self.NAME"


@slip
def async_publish(tree: ast.AST) -> Iterator[Place]:
    """Find a call of the file's own `async def` that nobody awaits: it does not run."""
    own = {node.name for node in nodes_of(tree, ast.AsyncFunctionDef)}
    for node in nodes_of(tree, ast.Expr):
        if isinstance(node.value, ast.Call):
            name = unparse(node.value.func)
            if name.removeprefix("self.") in own:
                yield (
                    node.lineno,
                    f"{name}() makes a coroutine that nobody awaits, so it does not run: def without async",
                )
