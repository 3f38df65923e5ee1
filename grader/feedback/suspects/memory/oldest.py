"""Suspects in which of several kept messages is taken: the oldest where the newest is meant."""

from __future__ import annotations

import ast

from gz_course.grader.feedback.facts.syntax import Words, assigned, calls, functions, unparse
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About
from gz_course.grader.feedback.suspects.memory.old_values import FIRST

ADDS = frozenset({"append", "appendleft"})


@suspicion_of(About.POSE)
def oldest_taken(tree: ast.AST) -> Words:
    """Find `self.poses[0]` as the pose of now, where each message is appended to `self.poses`."""
    listening = [each for each in functions(tree) if ".pose.pose" in unparse(each) or "_odom" in each.name]
    kept: dict[str, str] = {}
    for function in listening:
        for call, name in calls(function):
            if name in ADDS and isinstance(call.func, ast.Attribute) and isinstance(call.func.value, ast.Attribute):
                kept[unparse(call.func.value)] = name
    for function in functions(tree):
        for target, value in assigned(function):
            if isinstance(value, ast.Call) and unparse(value) in {f"min({each})" for each in kept}:
                yield value, f"{unparse(value)} is the oldest pose that is kept: [-1] is the newest"
            part = value.value if isinstance(value, ast.Attribute) else value
            whole = part.value if isinstance(part, ast.Subscript) else part
            name, adds = unparse(whole), kept.get(unparse(whole), "")
            if not isinstance(part, ast.Subscript) or not adds or _on_purpose(target):
                continue
            old, new = ("0", "-1") if adds == "append" else ("-1", "0")
            if unparse(part.slice) == old and f"{name}[{new}]" not in unparse(function):
                yield (
                    part,
                    f"{name}[{old}] is the oldest pose that is kept, not the present one, because {adds}() adds at the "
                    f"other end: {name}[{new}] is the newest",
                )


def _on_purpose(target: ast.expr) -> bool:
    return any(part in unparse(target).lower() for part in FIRST)
