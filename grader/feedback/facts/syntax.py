"""Looks into a student's Python: one that is not Python, or is nested too deeply to be looked at, has no places."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator
from functools import lru_cache
from typing import Any

Place = tuple[int, str]  # line, and the words of a sentence
Suspect = tuple[int, str, str]  # line, what it is about, and the words of a sentence
Places = list[dict[str, Any]]
# Nodes of a syntax tree, each counted once for every node above it: what it costs to look into each statement from
# each of those around it. The longest solution has a third of that.
MOST_WORK = 30_000
WALKED = "_walked"
GIVEN_UP = (SyntaxError, ValueError, RecursionError, MemoryError)


def walk(node: ast.AST) -> tuple[ast.AST, ...]:
    """Return a node and all nodes below it, as `ast.walk` does. The node keeps them: a hundred looks ask for them."""
    kept: tuple[ast.AST, ...] | None = node.__dict__.get(WALKED)
    if kept is None:
        kept = node.__dict__[WALKED] = tuple(ast.walk(node))
    return kept


def functions(tree: ast.AST) -> Iterator[ast.FunctionDef]:
    return (node for node in walk(tree) if isinstance(node, ast.FunctionDef))


def last_name(node: ast.AST) -> str:
    """Return the last part of a name, such as `Node` of `launch_ros.actions.Node`; empty if it is no name."""
    if isinstance(node, ast.Attribute):
        return node.attr
    return node.id if isinstance(node, ast.Name) else ""


def calls(tree: ast.AST) -> Iterator[tuple[ast.Call, str]]:
    """Yield every call with the last part of the name that is called: `cos` of `math.cos(x)`."""
    return ((node, last_name(node.func)) for node in walk(tree) if isinstance(node, ast.Call))


def called(tree: ast.AST) -> set[str]:
    """Return the last parts of the names of all that is called."""
    return {name for _, name in calls(tree)}


def assigned(tree: ast.AST) -> Iterator[tuple[ast.expr, ast.expr]]:
    """Yield every target of an assignment with its value; the parts of tuples one by one."""
    for node in walk(tree):
        if isinstance(node, ast.AugAssign | ast.AnnAssign) and node.value is not None:
            yield node.target, node.value
        if not isinstance(node, ast.Assign):
            continue
        for target in node.targets:
            if isinstance(target, ast.Tuple) and isinstance(node.value, ast.Tuple):
                yield from zip(target.elts, node.value.elts, strict=False)
            else:
                yield target, node.value


def set_to(tree: ast.AST) -> dict[str, list[ast.expr]]:
    """Return what each name and attribute of a file is set to."""
    found: dict[str, list[ast.expr]] = {}
    for target, value in assigned(tree):
        found.setdefault(ast.unparse(target), []).append(value)
    return found


def is_none(node: ast.AST) -> bool:
    return isinstance(node, ast.Constant) and node.value is None


def left_early(loop: ast.AST) -> bool:
    """Return whether a loop has a `break` or a `return` in it."""
    return any(isinstance(each, ast.Break | ast.Return) for each in walk(loop))


def assignments(tree: ast.AST) -> Iterator[tuple[ast.expr, ast.Assign]]:
    """Yield each assignment to a single target, after the target."""
    for node in walk(tree):
        if isinstance(node, ast.Assign) and len(node.targets) == 1:
            yield node.targets[0], node


def places_in(content: bytes, look: Callable[[ast.Module], Places]) -> Places:
    """Return what `look` finds in the syntax tree of a file; nothing if Python gives up parsing or looking.

    A file that is far longer than any solution has none: looks compare its statements with each other.
    """
    try:
        tree = _parsed(content)
        return look(tree) if _work(tree) <= MOST_WORK else []
    except GIVEN_UP:
        return []


def parsed(content: bytes) -> ast.Module:
    """Return the syntax tree of a file; an empty one if Python gives up parsing it."""
    try:
        return _parsed(content)
    except GIVEN_UP:
        return ast.Module(body=[], type_ignores=[])


@lru_cache(maxsize=8)  # a grading looks into the same few files for a dozen kinds of places
def _parsed(content: bytes) -> ast.Module:
    return ast.parse(content)


def _work(tree: ast.AST) -> int:
    work, level, depth = 0, [tree], 0
    while level and work <= MOST_WORK:
        work += len(level) * depth
        level = [child for node in level for child in ast.iter_child_nodes(node)]
        depth += 1
    return work
