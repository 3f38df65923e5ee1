"""Looks into a student's Python: one that is not Python, or is nested too deeply to be looked at, has no places."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator
from typing import Any

Places = list[dict[str, Any]]


def assignments(tree: ast.AST) -> Iterator[tuple[ast.expr, ast.Assign]]:
    """Yield each assignment to a single target, after the target."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Assign) and len(node.targets) == 1:
            yield node.targets[0], node


def places_in(content: bytes, look: Callable[[ast.Module], Places]) -> Places:
    """Return what `look` finds in the syntax tree of a file; nothing if Python gives up parsing or looking."""
    try:
        return look(ast.parse(content))
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return []
