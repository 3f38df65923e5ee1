"""Methods that are called once, in `__init__`, and never again, although they wait for what a message brings."""

from __future__ import annotations

import ast

from gz_course.grader.feedback.facts.syntax import Words, assigned, called, nodes_of, unparse
from gz_course.grader.feedback.slips import slip_of

Function = ast.FunctionDef | ast.AsyncFunctionDef


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
