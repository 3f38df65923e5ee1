"""Methods that nothing calls although they alone set what others read, as where one callback is passed twice."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Place, called, nodes_of, unparse
from gz_course.grader.feedback.slips import slip
from gz_course.grader.feedback.slips.nodes.callbacks import handed_over

Function = ast.FunctionDef | ast.AsyncFunctionDef


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
