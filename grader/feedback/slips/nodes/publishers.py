"""Publishers that nothing uses, and publishers that are made for a single message, which nobody can hear."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Place, Words, called, calls, unparse, walk
from gz_course.grader.feedback.slips import slip, slip_of

BEFORE = ("map_starts",)

BEGINNINGS = frozenset({"__init__", "main"})
WAITS = frozenset({"spin", "spin_once", "sleep", "wait", "get_subscription_count"})


@slip
def never_published(tree: ast.AST) -> Iterator[Place]:
    """Find a publisher in a file in which nothing is ever published."""
    if any(getattr(node, "attr", getattr(node, "id", "")) == "publish" for node in walk(tree)):
        return
    for call, name in calls(tree):
        if name == "create_publisher":
            yield (
                call.lineno,
                "this publisher is made, but nothing in the file calls its publish(), which sends a message; a line in "
                "the log reaches no topic",
            )


@slip_of(ast.FunctionDef)
def made_for_one_message(function: ast.FunctionDef) -> Words:
    """Find a callback that makes a publisher and publishes at once."""
    nested = sum(isinstance(each, ast.FunctionDef | ast.Lambda) for each in walk(function)) > 1
    if function.name in BEGINNINGS or nested or WAITS & called(function):
        return
    made = {
        unparse(node.targets[0]): node.lineno
        for node in function.body
        if isinstance(node, ast.Assign) and "create_publisher" in called(node.value)
    }
    sends = {
        unparse(call.func.value)
        for call, name in calls(function)
        if name == "publish" and isinstance(call.func, ast.Attribute)
    }
    for publisher in sends & set(made):
        yield (
            made[publisher],
            f"{function.name} makes the publisher and publishes at once, before anybody has found it, so the "
            "message is lost: a publisher is made once, in __init__",
        )
