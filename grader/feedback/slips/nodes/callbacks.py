"""Callbacks that are passed wrongly, never called, or called once; publishers that are for nobody."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Place, Words, assigned, called, calls, nodes_of, unparse, walk
from gz_course.grader.feedback.slips import slip, slip_of

BEFORE = ("map_starts",)

Function = ast.FunctionDef | ast.AsyncFunctionDef
# Method -> position of its callback.
CREATE = {
    "create_timer": 1, "create_subscription": 2, "create_service": 2, "add_on_set_parameters_callback": 0,
    "add_done_callback": 0, "registerCallback": 0, "ActionServer": 3,
}  # fmt: skip
BEGINNINGS = frozenset({"__init__", "main"})
WAITS = frozenset({"spin", "spin_once", "sleep", "wait", "get_subscription_count"})


@slip_of(ast.ClassDef)
def once_before_any_message(owner: ast.ClassDef, tree: ast.AST) -> Words:
    """Find `self.control()` in `__init__`, the only call of a method that returns while an attribute is None."""
    methods = {node.name: node for node in owner.body if isinstance(node, Function)}
    start = methods.get("__init__")
    if start is None or "create_subscription" not in called(owner):
        return
    none = {unparse(t) for t, value in assigned(start) if isinstance(value, ast.Constant) and not value.value}
    for statement in start.body:
        call = statement.value if isinstance(statement, ast.Expr) else None
        if not isinstance(call, ast.Call) or not isinstance(call.func, ast.Attribute):
            continue
        name = call.func.attr
        method = methods.get(name)
        if method is None or unparse(call.func.value) != "self" or "publish" not in called(method):
            continue
        missing = _awaited(method, none)
        used = [n for n in nodes_of(tree, ast.Attribute) if n.attr == name]
        if missing and len(used) == 1 and "spin_once" not in called(start):
            yield (
                call,
                f"{name} is called once, here in __init__, where {missing} is not there yet, so it returns; "
                f"nothing calls it again: self.create_timer(PERIOD, self.{name}) does",
            )


def _awaited(method: Function, none: set[str]) -> str:
    """Return the attribute without which a method returns at its beginning; empty if there is none."""
    for statement in method.body[:3]:
        if isinstance(statement, ast.If) and any(isinstance(each, ast.Return) for each in statement.body):
            asked = {unparse(each) for each in nodes_of(statement.test, ast.Attribute)}
            test = unparse(statement.test)
            names = [each for each in sorted(asked & none) if f"{each} is None" in test or f"not {each}" in test]
            if names:
                return names[0]
    return ""


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


@slip
def never_published(tree: ast.AST) -> Iterator[Place]:
    """Find a publisher in a file in which nothing is ever published."""
    if any(getattr(node, "attr", getattr(node, "id", "")) == "publish" for node in walk(tree)):
        return
    for call, name in calls(tree):
        if name == "create_publisher":
            yield (
                call.lineno,
                "this publisher is made, but nothing in the file calls its publish(), which sends a message; a line in "
                "the log reaches no topic",
            )


@slip_of(ast.FunctionDef)
def made_for_one_message(function: ast.FunctionDef) -> Words:
    """Find a callback that makes a publisher and publishes at once."""
    nested = sum(isinstance(each, ast.FunctionDef | ast.Lambda) for each in walk(function)) > 1
    if function.name in BEGINNINGS or nested or WAITS & called(function):
        return
    made = {
        unparse(node.targets[0]): node.lineno
        for node in function.body
        if isinstance(node, ast.Assign) and "create_publisher" in called(node.value)
    }
    sends = {
        unparse(call.func.value)
        for call, name in calls(function)
        if name == "publish" and isinstance(call.func, ast.Attribute)
    }
    for publisher in sends & set(made):
        yield (
            made[publisher],
            f"{function.name} makes the publisher and publishes at once, before anybody has found it, so the "
            "message is lost: a publisher is made once, in __init__",
        )


@slip
def never_called(tree: ast.AST) -> Iterator[Place]:
    """Find a method whose name stands nowhere else, and which alone sets an attribute after `__init__`."""
    used = _mentioned(tree)
    if not any(name.startswith("spin") for name in used):
        return  # others may use this file
    for owner in nodes_of(tree, ast.ClassDef):
        if "create_subscription" not in called(owner):
            continue
        methods = [node for node in owner.body if isinstance(node, Function)]
        for method in methods:
            if method.name in used or method.decorator_list or method.name.startswith("__"):
                continue
            if not (lost := _set_here_alone(method, methods, tree)):
                continue
            line, twice = _passed_twice(tree, method)
            yield (
                line or method.lineno,
                f"{twice}nothing calls {method.name}, which alone sets self.{lost}, so self.{lost} stays as __init__ "
                "has left it",
            )


def _mentioned(tree: ast.AST) -> set[str]:
    """Return all names that are read in a file, and the texts in it, by which getattr() may find a method."""
    found = {node.attr for node in nodes_of(tree, ast.Attribute)}
    found |= {node.id for node in nodes_of(tree, ast.Name)}
    constants = [node.value for node in nodes_of(tree, ast.Constant)]
    return found | {value for value in constants if isinstance(value, str)}


def _set_here_alone(method: Function, methods: list[Function], tree: ast.AST) -> str:
    """Return an attribute that a method sets, no other but `__init__` does, and another one reads; else nothing."""
    others = [each for each in methods if each is not method]
    set_elsewhere = {name for each in others if each.name != "__init__" for name in _attributes(each, ast.Store)}
    outside = {
        node.attr
        for node in nodes_of(tree, ast.Attribute)
        if isinstance(node.ctx, ast.Store) and unparse(node.value) != "self"
    }
    begun = {name for each in others if each.name == "__init__" for name in _attributes(each, ast.Store)}
    read = {name for each in others for name in _attributes(each, ast.Load)}
    lost = [name for name in _attributes(method, ast.Store) if name in begun & read - set_elsewhere - outside]
    return lost[0] if lost else ""


def _attributes(node: ast.AST, context: type[ast.expr_context]) -> list[str]:
    return [
        each.attr
        for each in nodes_of(node, ast.Attribute)
        if isinstance(each.ctx, context) and unparse(each.value) == "self"
    ]


def _passed_twice(tree: ast.AST, unused: Function) -> tuple[int, str]:
    """Return the line of the second of two subscriptions with one callback, and the words on it; 0 and empty."""
    seen: dict[str, int] = {}
    for call, given in handed_over(tree):
        if len(unused.args.args) != 2 or not unparse(call.func).endswith("create_subscription"):
            continue
        callback = unparse(given)
        if callback in seen:
            return call.lineno, f"this subscription calls {callback}, as that of line {seen[callback]} does, and "
        seen[callback] = call.lineno
    return 0, ""
