"""Mistakes with ROS parameters, and with texts that come from them, that raise no error; used by `slips.py`."""

from __future__ import annotations

import ast
from collections.abc import Iterator

Place = tuple[int, str]


def compared_by_identity(tree: ast.Module) -> Iterator[Place]:
    """Find `is` between a value and a text or a number, also one that has a name."""
    named = {
        target.id
        for node in tree.body
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant) and _plain(node.value)
        for target in node.targets
        if isinstance(target, ast.Name)
    }
    for node in ast.walk(tree):
        if not isinstance(node, ast.Compare) or not isinstance(node.ops[0], ast.Is | ast.IsNot):
            continue
        sides = (node.left, *node.comparators)
        if any(isinstance(side, ast.Constant) and side.value is None for side in sides):
            continue
        if any(_plain(side) or (isinstance(side, ast.Name) and side.id in named) for side in sides):
            right = "==" if isinstance(node.ops[0], ast.Is) else "!="
            yield (
                node.lineno,
                f"{ast.unparse(node)[:60]} asks whether both are the same object; equal texts and numbers, such as the "
                f"value of a parameter, are often two objects: compare with {right}",
            )


def _plain(node: ast.AST) -> bool:
    return isinstance(node, ast.Constant) and type(node.value) in (str, int, float)


def callbacks_without_result(tree: ast.AST) -> Iterator[Place]:
    """Find a callback for changes of parameters that returns nothing, or a truth value."""
    functions = {node.name: node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)}
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call) or not ast.unparse(node.func).endswith("add_on_set_parameters_callback"):
            continue
        name = ast.unparse(node.args[0]).rpartition(".")[2] if node.args else ""
        if name not in functions:
            continue
        returned = [each.value for each in ast.walk(functions[name]) if isinstance(each, ast.Return)]
        if all(value is None or isinstance(value, ast.Constant) for value in returned):
            yield (
                functions[name].lineno,
                f"{name}() is asked whether a parameter may change, and must return SetParametersResult("
                "successful=True) of rcl_interfaces.msg; with another answer, or none, the change is refused",
            )


LOOKS = (compared_by_identity, callbacks_without_result)
