"""Suspects in handlers that hide every error of a callback (`hidden`), of a node that does nothing or never ends."""

from __future__ import annotations

import ast

from gz_course.grader.feedback.facts.syntax import Words, called, last_name, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

ANY_ERROR = ("", "Exception", "BaseException", "TypeError", "AttributeError", "NameError", "ValueError", "IndexError")
SAYING = frozenset({"error", "warning", "warn", "fatal", "info", "print", "print_exc", "exception"})
LOOPS = frozenset({"spin", "spin_once", "shutdown"})
LOOKUPS = frozenset({"lookup_transform", "transform", "wait_for_transform"})


@suspicion_of(About.HIDDEN)
def hidden(tree: ast.AST) -> Words:
    """Find a handler that goes on after any error, or after one of the programmer's, and says nothing of it."""
    for node in walk(tree):
        inside = {name for statement in node.body for name in called(statement)} if isinstance(node, ast.Try) else LOOPS
        if not isinstance(node, ast.Try) or inside & LOOPS:
            continue
        lines = f"{node.body[0].lineno} to {node.body[-1].end_lineno}"
        for handler in node.handlers:
            kind = unparse(handler.type) if handler.type is not None else ""
            again = any(isinstance(each, ast.Raise) for each in walk(handler))
            known = last_name(handler.type) if handler.type is not None else ""
            if known not in ANY_ERROR or called(handler) & SAYING or again:
                continue
            way = "take it away" if not inside & LOOKUPS else "catch only what you expect, TransformException"
            said = f"{f'except {kind}'.strip()}: hides the errors of lines {lines}; {way}, and Python names the error"
            yield handler, said
