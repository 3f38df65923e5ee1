"""Keys of a dictionary that are read, and that nothing sets."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Place, calls, functions, last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.slips import slip

EMPTY = ("{}", "dict()")
ASKS = ("get", "pop")


@slip
def keys_that_nothing_sets(tree: ast.AST) -> Iterator[Place]:
    """Find `self.poses["me"]` in a file that begins with an empty dictionary, and never sets this key."""
    for name in _begun_empty(tree):
        stored = _stored(tree, name)
        if not stored or any(key is None for key, _ in stored):
            continue
        keys = {str(key) for key, _ in stored}
        for node in walk(tree):
            key = _read(node, name)
            if key is not None and key not in keys:
                lines = ", ".join(str(line) for line in sorted({line for _, line in stored})[:3])
                yield (
                    node.lineno,  # type: ignore[attr-defined]
                    f"nothing sets {name}[{key!r}]: what is set is {', '.join(map(repr, sorted(keys)))} (line {lines})",
                )
                break


def _begun_empty(tree: ast.AST) -> list[str]:
    """Return the dictionaries of the node that are empty at first, and are used by their keys alone."""
    made: dict[str, list[str]] = {}
    for node in nodes_of(tree, ast.Assign, ast.AnnAssign):
        if node.value is not None:
            for target in node.targets if isinstance(node, ast.Assign) else [node.target]:
                if isinstance(target, ast.Attribute):
                    made.setdefault(unparse(target), []).append(unparse(node.value))
    return [name for name, values in made.items() if set(values) <= set(EMPTY) and _by_keys_alone(tree, name)]


def _by_keys_alone(tree: ast.AST, name: str) -> bool:
    """Return whether a dictionary is handed to nobody, and no method of it sets keys."""
    known = {id(node.value) for node in nodes_of(tree, ast.Subscript, ast.Attribute)}
    known |= {id(target) for node in nodes_of(tree, ast.Assign) for target in node.targets}
    known |= {id(node.target) for node in nodes_of(tree, ast.AnnAssign)}
    known |= {id(each) for node in nodes_of(tree, ast.Compare) for each in node.comparators}
    known |= {id(each) for call, called in calls(tree) if called == "len" for each in call.args}
    for node in walk(tree):
        if isinstance(node, ast.Attribute) and unparse(node) == name and id(node) not in known:
            return False
        if isinstance(node, ast.Attribute) and node.attr == "update" and unparse(node.value) == name:
            return False
    return True


def _stored(tree: ast.AST, name: str) -> list[tuple[str | None, int]]:
    """Return the keys that are set, with the lines that give them; None for one that is not known."""
    found: list[tuple[str | None, int]] = []
    for function in functions(tree):
        parameters = [each.arg for each in function.args.args]
        for node in walk(function):
            key = None
            if isinstance(node, ast.Subscript) and isinstance(node.ctx, ast.Store) and unparse(node.value) == name:
                key = node.slice
            elif isinstance(node, ast.Call) and unparse(node.func) == f"{name}.setdefault" and node.args:
                key = node.args[0]
            if isinstance(key, ast.Name) and key.id in parameters:
                found += _handed(tree, function, parameters.index(key.id), key.id)
            elif key is not None:
                known = isinstance(key, ast.Constant) and isinstance(key.value, str)
                found.append((key.value if known else None, node.lineno))  # type: ignore[attr-defined]
    return found


def _handed(tree: ast.AST, function: ast.FunctionDef, place: int, name: str) -> list[tuple[str | None, int]]:
    """Return the texts that a function of the file is given for one of its parameters."""
    bound = bool(function.args.args) and function.args.args[0].arg == "self"
    found: list[tuple[str | None, int]] = []
    seen = 0
    for call, called in calls(tree):
        given: list[ast.expr] | None = None
        if called == function.name:
            given = call.args[place - bound :][:1]
        elif called == "partial" and call.args and last_name(call.args[0]) == function.name:
            given = call.args[1 + place - bound :][:1]
        if given is None:
            continue
        seen += 1
        given = given or [each.value for each in call.keywords if each.arg == name]
        value = given[0] if given else None
        known = isinstance(value, ast.Constant) and isinstance(value.value, str)
        found.append((value.value if known else None, call.lineno))  # type: ignore[union-attr]
    named = sum(1 for node in walk(tree) if last_name(node) == function.name)
    return found if seen and named == seen else [(None, function.lineno)]


def _read(node: ast.AST, name: str) -> str | None:
    """Return the text by which a dictionary is read; None if a node is something else."""
    match node:
        case ast.Subscript(value=owner, slice=ast.Constant(value=str() as key), ctx=ast.Load()):
            return key if unparse(owner) == name else None
        case ast.Call(func=ast.Attribute(value=owner, attr=method), args=[ast.Constant(value=str() as key), *_]):
            return key if method in ASKS and unparse(owner) == name else None
    return None
