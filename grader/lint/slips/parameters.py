"""Mistakes with ROS parameters that raise no error; used by `slips.py`."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.lint.syntax import Place


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


LOOKS = (callbacks_without_result,)
