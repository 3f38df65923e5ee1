"""Suspects of files that send velocities and hear of nothing but odometry: they drive for a time, to no goal."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator
from functools import wraps

from gz_course.grader.feedback.facts.syntax import assigned, called, calls, kept, unparse
from gz_course.grader.feedback.suspects import suspicion
from gz_course.grader.feedback.suspects.about import Suspect

Rule = Callable[[ast.Module], Iterator[Suspect]]
OTHER_TASKS = frozenset({
    "ActionServer", "ActionClient", "create_service", "create_client", "lookup_transform", "declare_parameters",
})  # fmt: skip


def of_a_plain_drive(rule: Rule) -> Rule:
    """Register a suspect that is looked for in such files only."""

    @suspicion
    @wraps(rule)
    def find(tree: ast.Module) -> Iterator[Suspect]:
        if _is_plain_drive(tree):
            yield from rule(tree)

    return find


@kept
def _is_plain_drive(tree: ast.Module) -> bool:
    heard = {unparse(call.args[0]) for call, name in calls(tree) if name == "create_subscription" and call.args}
    return any(set_speeds(tree)) and heard <= {"Odometry", "Clock"} and not called(tree) & OTHER_TASKS


def set_speeds(node: ast.AST) -> Iterator[tuple[ast.expr, ast.expr]]:
    """Yield the assignments of `linear.x`: the whole target, and its value."""
    return ((target, value) for target, value in assigned(node) if unparse(target).endswith(".linear.x"))
