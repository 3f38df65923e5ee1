"""Suspects of files that send velocities and hear of nothing but odometry: they drive for a time, to no goal."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator
from functools import wraps

from gz_course.grader.feedback.facts.syntax import Words, assigned, called, calls, kept, unparse
from gz_course.grader.feedback.suspects import Suspicion, suspicion_of
from gz_course.grader.feedback.suspects.about import About

OTHER_TASKS = frozenset({
    "ActionServer", "ActionClient", "create_service", "create_client", "lookup_transform", "declare_parameters",
})  # fmt: skip


def of_a_plain_drive(about: About) -> Callable[[Callable[[ast.Module], Words]], Suspicion]:
    """Register a suspect that is looked for in such files only."""

    def register(rule: Callable[[ast.Module], Words]) -> Suspicion:
        @wraps(rule)
        def find(tree: ast.Module) -> Words:
            if _is_plain_drive(tree):
                yield from rule(tree)

        return suspicion_of(about)(find)

    return register


@kept
def _is_plain_drive(tree: ast.Module) -> bool:
    heard = {unparse(call.args[0]) for call, name in calls(tree) if name == "create_subscription" and call.args}
    return any(set_speeds(tree)) and heard <= {"Odometry", "Clock"} and not called(tree) & OTHER_TASKS


def set_speeds(node: ast.AST) -> Iterator[tuple[ast.expr, ast.expr]]:
    """Yield the assignments of `linear.x`: the whole target, and its value."""
    return ((target, value) for target, value in assigned(node) if unparse(target).endswith(".linear.x"))
