"""Mistakes with ROS parameters that raise no error; used by `slips.py`."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.lint.syntax import Place, calls

VALUES = {"double_value": float, "integer_value": int, "string_value": str, "bool_value": bool}
ARTICLES = {float: "a float", int: "an integer", str: "a text", bool: "a truth value"}


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


def values_of_another_type(tree: ast.AST) -> Iterator[Place]:
    """Find `get_parameter('x').get_parameter_value().double_value` of a parameter that was declared as no float."""
    declared = {}
    for call, called in calls(tree):
        match call.args:
            case [ast.Constant(value=str(name)), ast.Constant(value=default)] if called == "declare_parameter":
                declared[name] = default
    for node in ast.walk(tree):
        match node:
            case ast.Attribute(
                value=ast.Call(
                    func=ast.Attribute(
                        value=ast.Call(func=ast.Attribute(attr="get_parameter"), args=[ast.Constant(value=str(name))]),
                        attr="get_parameter_value",
                    )
                ),
                attr=field,
            ) if field in VALUES and type(declared.get(name)) in set(ARTICLES) - {VALUES[field]}:
                yield (
                    node.lineno,
                    f"{field} of the parameter {name} is never set, because declare_parameter({name!r}, "
                    f"{declared[name]!r}) makes it {ARTICLES[type(declared[name])]}: .value is its value whatever the "
                    f"type, and a default of the type {VALUES[field].__name__} makes it one of that type",
                )


LOOKS = (
    values_of_another_type,
    callbacks_without_result,
)
