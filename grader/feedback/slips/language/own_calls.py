"""Calls of functions of the file whose arguments come in another order than the parameters."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Place, functions, kept, last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.slips import slip

EITHER = {"start", "goal", "end", "first", "second", "source", "target", "here", "there"}  # in both orders on purpose
SYMMETRIC = re.compile(r"dist|between|near|close|same|apart|away|gap|length|swap|way|path|route|touch")


@slip
def exchanged_names(tree: ast.AST) -> Iterator[Place]:
    """Find `drive(turn, speed)` where the file has `def drive(speed, turn)` and no call in the right order."""
    for function, given in calls_of_own(tree):
        params = parameters(function)
        if SYMMETRIC.search(function.name.lower()):
            continue
        for i, first in enumerate(params):
            for k, second in enumerate(params[i + 1 :], i + 1):
                pairs = [(last_name(call.args[i]), last_name(call.args[k])) for call in given if len(call.args) > k]
                if (
                    EITHER & {first, second}
                    or _letters(first, second)
                    or (first, second) in pairs
                    or (second, first) not in pairs
                ):
                    continue
                call = next(
                    call
                    for call in given
                    if len(call.args) > k and (last_name(call.args[i]), last_name(call.args[k])) == (second, first)
                )
                order = ", ".join(params)
                yield (
                    call.lineno,
                    f"{unparse(call)[:60]} has {second} and {first} in the wrong order: the function, in line "
                    f"{function.lineno}, is {function.name}({order})",
                )


def _letters(first: str, second: str) -> bool:
    """Say whether the names of two parameters are single letters that mean nothing, such as a and b."""
    return len(first) == len(second) == 1 and {first, second} != {"x", "y"}


@kept
def calls_of_own(tree: ast.AST) -> tuple[tuple[ast.FunctionDef, list[ast.Call]], ...]:
    """Return each function whose name is defined once, with the calls of it from other functions."""
    defined = list(functions(tree))
    names = [function.name for function in defined]
    found: list[tuple[ast.FunctionDef, list[ast.Call]]] = []
    for function in defined:
        own = {id(node) for node in walk(function)}
        if names.count(function.name) != 1 or any(
            isinstance(node, ast.Call) and last_name(node.func) == function.name for node in walk(function)
        ):
            continue
        method = is_method(function)
        given = [
            node
            for node in nodes_of(tree, ast.Call)
            if id(node) not in own
            and last_name(node.func) == function.name
            and isinstance(node.func, ast.Attribute) == method
            and not any(isinstance(each, ast.Starred) for each in node.args)
        ]
        found.append((function, given))
    return tuple(found)


def is_method(function: ast.FunctionDef) -> bool:
    """Say whether the first parameter is self, or the function a static method."""
    static = any(last_name(each) == "staticmethod" for each in function.decorator_list)
    return static or (bool(function.args.args) and function.args.args[0].arg == "self")


def parameters(function: ast.FunctionDef) -> list[str]:
    """Return the names of the parameters that a call gives in order, without self."""
    names = [each.arg for each in [*function.args.posonlyargs, *function.args.args]]
    return names[1:] if names[:1] == ["self"] else names
