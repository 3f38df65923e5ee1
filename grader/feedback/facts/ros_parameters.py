"""The ROS parameters of a student's node: what it declares, where it reads them, which functions hear of changes."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import (
    assigned,
    calls,
    children,
    functions,
    kept,
    last_name,
    nodes_of,
    unparse,
    walk,
)

ASKS = frozenset({"get_parameter", "get_parameter_or"})
OF_MANY = frozenset({"get_parameters", "get_parameters_by_prefix", "get_parameter_types"})
HEARS = frozenset({"add_on_set_parameters_callback", "add_post_set_parameters_callback"})
MODULE = "<module>"
Function = ast.FunctionDef | ast.AsyncFunctionDef


@kept
def declared(tree: ast.AST) -> dict[str, tuple[int, ast.expr | None]] | None:
    """Return line and default of each parameter that is declared; None if a name is not written as a text."""
    found: dict[str, tuple[int, ast.expr | None]] = {}
    for call, name in calls(tree):
        given: list[tuple[ast.expr, ast.expr | None]] = []
        if name == "declare_parameter" and call.args:
            given = [(call.args[0], call.args[1] if len(call.args) > 1 else None)]
            if isinstance(call.args[0], ast.Name):
                given = _listed(tree, call) or given
        elif name == "declare_parameters":
            rows = [*call.args[1:2], *(each.value for each in call.keywords if each.arg == "parameters")]
            if not rows or not isinstance(rows[0], ast.List | ast.Tuple):
                return None
            for row in rows[0].elts:
                if not isinstance(row, ast.Tuple | ast.List) or not row.elts:
                    return None
                given.append((row.elts[0], row.elts[1] if len(row.elts) > 1 else None))
        for one, default in given:
            if not isinstance(one, ast.Constant) or not isinstance(one.value, str):
                return None
            found.setdefault(one.value, (one.lineno, default))
    return found


def _listed(tree: ast.AST, call: ast.Call) -> list[tuple[ast.expr, ast.expr | None]]:
    """Return name and default of each parameter that a loop over literal pairs declares by a call; none otherwise."""
    for loop in walk(tree):
        match loop:
            case ast.For(target=ast.Tuple(elts=[ast.Name(id=name), ast.Name(id=value)]), iter=rows):
                pass
            case _:
                continue
        if not any(each is call for each in walk(loop)) or [unparse(each) for each in call.args] != [name, value]:
            continue
        match rows:
            case ast.Call(func=ast.Attribute(value=ast.Dict(keys=keys, values=values), attr="items")):
                return [(key, default) for key, default in zip(keys, values, strict=True) if key is not None]
            case ast.List(elts=pairs) | ast.Tuple(elts=pairs):
                return [
                    (pair.elts[0], pair.elts[1])
                    for pair in pairs
                    if isinstance(pair, ast.Tuple) and len(pair.elts) == 2
                ]
    return []


@kept
def readers(tree: ast.AST) -> set[str]:
    """Return the file's own functions that pass one of their arguments to get_parameter()."""
    return {
        function.name
        for function in functions(tree)
        for call, name in calls(function)
        if name in ASKS and call.args and last_name(call.args[0]) in {each.arg for each in function.args.args} - {""}
    }


def reads(tree: ast.AST) -> Iterator[tuple[ast.Call, str]]:
    """Yield each call that reads a parameter, with the parameter's name; empty if that is not written as a text."""
    own = readers(tree)
    inside = {id(call) for function in functions(tree) if function.name in own for call, _ in calls(function)}
    for call, name in calls(tree):
        if name in OF_MANY:
            yield call, ""
        elif (name in ASKS and id(call) not in inside) or (name in own and call.args):
            first = call.args[0] if call.args else None
            yield call, str(first.value) if isinstance(first, ast.Constant) else ""


@kept
def owners(tree: ast.Module) -> dict[int, str]:
    """Return in which function each node stands, by its id: the innermost that has a name."""
    found: dict[int, str] = {}

    def go(node: ast.AST, name: str) -> None:
        for child in children(node):
            inner = child.name if isinstance(child, Function) else name
            found[id(child)] = inner
            go(child, inner)

    go(tree, MODULE)
    return found


@kept
def only_at_the_start(tree: ast.Module) -> set[str]:
    """Return the functions that run once: __init__, main, and those that nobody but these calls or passes on."""
    inside, once = owners(tree), {MODULE, "__init__", "main"}
    used: dict[str, set[str]] = {}
    for node in nodes_of(tree, ast.Attribute, ast.Name):
        if isinstance(node.ctx, ast.Load):
            used.setdefault(last_name(node), set()).add(inside[id(node)])
    direct = {last_name(call.func) for call, _ in calls(tree)}
    passed = {last_name(each) for call, _ in calls(tree) for each in [*call.args, *(k.value for k in call.keywords)]}
    for _ in range(3):  # functions that are called by functions
        for function in functions(tree):
            name = function.name
            if name in direct - passed and used.get(name, set()) <= once:
                once.add(name)
    return once


def listeners(tree: ast.AST) -> list[ast.FunctionDef]:
    """Return the functions that are given to add_on_set_parameters_callback()."""
    names = {last_name(call.args[0]) for call, name in calls(tree) if name in HEARS and call.args}
    return [each for each in functions(tree) if each.name in names]


def members(function: ast.FunctionDef) -> set[str]:
    """Return the names that hold one Parameter each in a callback for changes: those of loops over its argument."""
    given = {each.arg for each in function.args.args} - {"self"}
    return {
        node.target.id
        for node in nodes_of(function, ast.For, ast.comprehension)
        if isinstance(node.target, ast.Name) and isinstance(node.iter, ast.Name) and node.iter.id in given
    }


@kept
def objects(tree: ast.AST) -> set[str]:
    """Return the names and attributes that hold what get_parameter() returns, and never anything else."""
    held: dict[str, list[bool]] = {}
    for target, value in assigned(tree):
        held.setdefault(unparse(target), []).append(
            isinstance(value, ast.Call) and last_name(value.func) in ASKS | {"declare_parameter"}
        )
    return {name for name, found in held.items() if all(found)}
