"""The calls of publish() in a Python file that come before its node waits for anything: nobody has found it yet."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Places, calls, children, functions, last_name, places_in

MOST = 2  # calls reported at most
WAITS = frozenset({"spin", "spin_once", "spin_until_future_complete", "sleep", "sleep_for", "wait", "wait_for_service"})
Block = ast.Module | ast.FunctionDef


def early_publishing(content: bytes) -> Places:
    """Return the `line` and the `function` (empty: that of the module) of each such call.

    It stands in `__init__`, in a method that `__init__` calls, or above whatever waits in a function that makes a node.
    """
    return places_in(content, lambda tree: [{"line": line, "function": name} for line, name in _early(tree)][:MOST])


def _early(tree: ast.Module) -> Iterator[tuple[int, str]]:
    methods = {function.name: function for function in functions(tree)}
    for function in functions(tree):
        if function.name != "__init__":
            continue
        for call, name in _own_calls(function):
            if name in WAITS:
                break
            own = name in methods and _is_of_self(call)
            if name == "publish" or (own and "publish" in _names(methods[name])):
                yield call.lineno, "__init__"
    blocks: list[Block] = [tree, *functions(tree)]
    for block in blocks:
        said = [(call, name) for call, name in _own_calls(block)]
        if not {"create_publisher", "create_node", "init"} & {name for _, name in said}:
            continue
        if isinstance(block, ast.FunctionDef) and block.name == "__init__":
            continue
        for call, name in said:
            if name in WAITS:
                break
            if name == "publish":
                yield call.lineno, getattr(block, "name", "")


def _is_of_self(call: ast.Call) -> bool:
    return isinstance(call.func, ast.Attribute) and last_name(call.func.value) == "self"


def _names(function: ast.FunctionDef) -> set[str]:
    return {name for _, name in calls(function)}


def _own_calls(block: Block) -> list[tuple[ast.Call, str]]:
    """Return the calls of a block in the order of their lines, without those of functions and classes in it."""
    found: list[ast.Call] = []
    todo: list[ast.AST] = list(block.body)
    while todo:
        node = todo.pop()
        if isinstance(node, ast.FunctionDef | ast.ClassDef | ast.Lambda | ast.AsyncFunctionDef):
            continue
        if isinstance(node, ast.Call):
            found.append(node)
        todo += children(node)
    ordered = sorted(found, key=lambda call: (call.lineno, call.col_offset))
    return [(call, last_name(call.func)) for call in ordered]
