"""Suspects in handlers that hide every error of a callback (`hidden`), of a node that does nothing or never ends."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.lint.syntax import Suspect, called

ANY_ERROR = ("", "Exception", "BaseException", "TypeError", "AttributeError", "NameError", "ValueError", "IndexError")
SAYING = frozenset({"error", "warning", "warn", "fatal", "info", "print", "print_exc", "exception"})
EXPECTED = frozenset({"lookup_transform", "transform", "wait_for_transform", "spin", "spin_once", "shutdown"})


def hidden(tree: ast.AST) -> Iterator[Suspect]:
    """Find a handler that goes on after any error, or after one of the programmer's, and says nothing of it."""
    for node in ast.walk(tree):
        if not isinstance(node, ast.Try) or any(called(statement) & EXPECTED for statement in node.body):
            continue
        for handler in node.handlers:
            kind = ast.unparse(handler.type) if handler.type is not None else ""
            again = any(isinstance(each, ast.Raise) for each in ast.walk(handler))
            if kind in ANY_ERROR and not called(handler) & SAYING and not again:
                yield (
                    handler.lineno,
                    "hidden",
                    f"{f'except {kind}'.strip()}: hides the errors of the lines below try, line {node.lineno}; take it "
                    "away, and Python names the error",
                )


LOOKS = (hidden,)
