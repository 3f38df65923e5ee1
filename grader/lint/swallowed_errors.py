"""Places that catch every error and show none, around what publishes: a mistake there stays unseen."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import Any

from gz_course.grader.lint.syntax import Places, called, functions, last_name, places_in

BROAD = frozenset({"", "Exception", "BaseException"})
MOST = 2  # places that are recorded


def swallowed_errors(content: bytes) -> Places:
    """Return the `line` of each such handler, and the `first` and the `last` line of what it is about."""
    return places_in(content, lambda tree: list(_swallowed(tree))[:MOST])


def _swallowed(tree: ast.Module) -> Iterator[dict[str, Any]]:
    publishing = {each.name for each in functions(tree) if "publish" in called(each)} | {"publish"}
    for node in (each for each in ast.walk(tree) if isinstance(each, ast.Try)):
        inside = {name for statement in node.body for name in called(statement)}
        for handler in node.handlers:
            broad = last_name(handler.type) in BROAD if handler.type is not None else True
            silent = not any(isinstance(each, ast.Call | ast.Raise) for part in handler.body for each in ast.walk(part))
            if broad and silent and inside & publishing and "spin" not in inside:
                last = node.body[-1].end_lineno
                yield {"line": handler.lineno, "first": node.body[0].lineno, "last": last}
