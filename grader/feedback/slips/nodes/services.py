"""Mistakes with the callbacks of services that show only when somebody calls."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Place, nodes_of, returned_by, unparse
from gz_course.grader.feedback.slips import slip

CALLBACK = 2  # place among the arguments of create_service


@slip
def no_response(tree: ast.AST) -> Iterator[Place]:
    """Find a callback of a service that never returns anything."""
    functions = {node.name: node for node in nodes_of(tree, ast.FunctionDef, ast.AsyncFunctionDef)}
    for call in nodes_of(tree, ast.Call):
        if unparse(call.func).rpartition(".")[2] != "create_service":
            continue
        named = [each.value for each in call.keywords if each.arg == "callback"]
        given = named or call.args[CALLBACK : CALLBACK + 1]
        function = functions.get(unparse(given[0]).rpartition(".")[2]) if given else None
        if function is None or isinstance(function.body[-1], ast.Raise):
            continue
        if all(value is None or unparse(value) == "None" for value in returned_by(function)):
            names = [each.arg for each in function.args.args]
            response = names[-1] if names else "response"
            yield (
                function.lineno,
                f"{function.name}() answers a service and returns nothing, so a call ends with an error and without an "
                f"answer: it must end with return {response}",
            )
