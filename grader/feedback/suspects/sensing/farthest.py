"""Suspects in what a node takes for the distance from a wall: the farthest range in place of the nearest."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Words, assigned, calls, functions, nodes_of, unparse
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

Loop = ast.For | ast.comprehension


@suspicion_of(About.FARTHEST)
def largest_range(tree: ast.Module) -> Words:
    """Find the largest of the ranges of a scan in a node that steers, where nothing takes the smallest."""
    if "angular.z" not in unparse(tree):
        return
    for function in functions(tree):
        lists = set(_of_ranges(function))
        given = [(call, name, unparse(call.args[0])) for call, name in calls(function) if len(call.args) == 1]
        if any(name in ("min", "nanmin", "argmin", "sorted", "sort") for _, name, _ in given):
            continue
        for call, name, text in given:
            if name in ("max", "nanmax") and (text in lists or text.partition("[")[0].endswith(".ranges")):
                yield (
                    call,
                    f"{unparse(call)[:60]} takes the farthest of the ranges: the distance from a wall is that of "
                    "its nearest point, min(...)",
                )


def _of_ranges(function: ast.FunctionDef) -> Iterator[str]:
    """Yield the names of lists that are filled from the ranges of a scan."""
    for node in nodes_of(function, ast.For):
        if ".ranges" in unparse(node.iter):
            for call, name in calls(node):
                if name == "append":
                    yield unparse(call.func).rpartition(".")[0]
    for target, value in assigned(function):
        if isinstance(value, ast.ListComp) and any(".ranges" in unparse(loop.iter) for loop in value.generators):
            yield unparse(target)
