"""Suspects in what is made of a place ahead and to the left, whatever both are called: `atan2(ahead, left)` (`axes`).

What is put into the x and the y of a message says which name is which; calls of the file's functions hand it on.
"""

from __future__ import annotations

import ast
import math

from gz_course.grader.feedback.facts.syntax import Words, assigned, calls, functions, unparse
from gz_course.grader.feedback.slips.geometry.rotations import SOME, pairs
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

OFFSETS = ast.Add | ast.Sub
STEPS = 4  # calls that hand a name on, at most


@suspicion_of(About.AXES)
def exchanged_directions(tree: ast.AST) -> Words:
    """Find atan2 of what is put into the x of a message, and of what is put into its y, in this order."""
    axes = _axes(tree)
    for function in functions(tree):
        known = axes.get(function.name, {})
        for call, name in calls(function):
            if name not in ("atan2", "arctan2") or len(call.args) != 2:
                continue
            if [known.get(_bare(each)) for each in call.args] == ["x", "y"]:
                ahead, left = (unparse(each) for each in call.args)
                right = f"{name}({left}, {ahead})"
                yield (
                    call,
                    f"{unparse(call)[:60]}: {name} takes y first, what is to the left, and that is {left} here: "
                    f"{right}",
                )


@suspicion_of(About.AXES)
def other_turns(tree: ast.AST) -> Words:
    """Find a pair of sums that turns a place, but not by plus the angle whose cosine and sine it has."""
    axes = _axes(tree)
    for function, ((first, row), (second, below)) in pairs(tree):
        known = axes.get(function.name, {})
        names = {axis: name for name in row if (axis := known.get(name))}
        if set(names) != {"x", "y"}:
            continue
        ahead, left = names["x"], names["y"]
        found = {(round(each[ahead], 6), round(each[left], 6)) for each in (row, below)}
        cosine, sine = round(math.cos(SOME), 6), round(math.sin(SOME), 6)
        if found != {(cosine, -sine), (sine, cosine)}:
            yield (
                first,
                f"{unparse(first)[:50]} and {unparse(second)[:50]} turn the wrong way: for x, it is "
                f"{ahead} * cos - {left} * sin, and for y {ahead} * sin + {left} * cos",
            )


def _axes(tree: ast.AST) -> dict[str, dict[str, str]]:
    """Return which names of each function are an x, and which a y."""
    found: dict[str, dict[str, str]] = {}
    for function in functions(tree):
        known = found.setdefault(function.name, {})
        for target, value in assigned(function):
            if isinstance(target, ast.Attribute) and target.attr in ("x", "y") and isinstance(value, ast.Name):
                known[value.id] = target.attr
    made = {
        function.name: [each.arg for each in function.args.args if each.arg != "self"] for function in functions(tree)
    }
    for _ in range(STEPS):
        for function in functions(tree):
            for call, name in calls(function):
                for parameter, given in zip(made.get(name, []), call.args, strict=False):
                    if axis := found[function.name].get(_bare(given)):
                        found[name].setdefault(parameter, axis)
    for function in functions(tree):
        known = found[function.name]
        for target, value in assigned(function):
            if isinstance(target, ast.Name) and (axis := known.get(_bare(value))):
                known.setdefault(target.id, axis)
    return found


def _bare(node: ast.expr) -> str:
    """Return a name, also with a constant added, such as the place of the camera; empty for anything else."""
    if isinstance(node, ast.BinOp) and isinstance(node.op, OFFSETS) and isinstance(node.right, ast.Constant):
        return _bare(node.left)
    return node.id if isinstance(node, ast.Name) else ""
