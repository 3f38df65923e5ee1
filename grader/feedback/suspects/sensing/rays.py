"""Suspects in what reads a scan: rays by their number, and ranges that are not looked at before they are compared."""

from __future__ import annotations

import ast

from gz_course.grader.feedback.facts.syntax import Words, assigned, last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

BEFORE = ("farthest", "feedback", "known_places")

COPIES = frozenset({"list", "tuple", "array", "asarray"})


@suspicion_of(About.RAY)
def by_number(tree: ast.AST) -> Words:
    """Find a ray, or a slice of rays, that is chosen by a number in the program."""
    names = {
        unparse(target)
        for target, value in assigned(tree)
        if isinstance(target, ast.Name) and unparse(_copied(value)).endswith(".ranges")
    }
    for node in nodes_of(tree, ast.Subscript):
        whole = unparse(node.value)
        if not whole.endswith("ranges") and whole not in names:
            continue
        if _numbered(node.slice):
            yield (
                node,
                f"{unparse(node)[:60]} takes a ray by its number: ray i looks to angle_min + i * angle_increment "
                "[rad], and 0 is ahead only if angle_min is 0",
            )


def _copied(value: ast.expr) -> ast.expr:
    """Return what `list(...)` or `np.array(...)` copies, or the value itself."""
    copies = isinstance(value, ast.Call) and last_name(value.func) in COPIES and len(value.args) > 0
    return value.args[0] if copies and isinstance(value, ast.Call) else value


def _numbered(index: ast.expr) -> bool:
    """Return whether an index is made of numbers alone; `[:, None]` adds an axis, and `[::-1]` leaves no ray out."""
    if isinstance(index, ast.Tuple):
        return False
    parts = [index.lower, index.upper] if isinstance(index, ast.Slice) else [index]
    inside = [each for part in parts if part is not None for each in walk(part)]
    names = any(isinstance(each, ast.Name | ast.Attribute | ast.Call) for each in inside)
    return not names and any(isinstance(each, ast.Constant) and isinstance(each.value, int) for each in inside)


@suspicion_of(About.RAY)
def smallest_of_all(tree: ast.AST) -> Words:
    whole = {unparse(target) for target, value in assigned(tree) if unparse(value).endswith(".ranges")}
    for node in nodes_of(tree, ast.Call):
        if last_name(node.func) == "min" and len(node.args) == 1:
            text = unparse(node.args[0])
            if (text.endswith(".ranges") or text in whole) and not node.keywords:
                yield (
                    node,
                    f"{unparse(node)[:60]} is the nearest in any direction, and includes ranges that are "
                    "not valid: choose the rays by their bearing, and those between range_min and range_max",
                )
