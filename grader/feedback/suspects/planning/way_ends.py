"""Suspects in which cell of a way a robot steers to: always the first, where it stands, or always the last."""

from __future__ import annotations

import ast

from gz_course.grader.feedback.facts.syntax import Words, assigned, called, calls, functions, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About
from gz_course.grader.feedback.suspects.planning.ways import SHORTENS, TURNS_ROUND, never_shortened

BEFORE = ("closed_gates",)

COLLECTS = frozenset({"append", "insert", "appendleft"})


@suspicion_of(About.WAY)
def ends_of_a_way(tree: ast.Module) -> Words:
    """Find a file that reads only the first, or only the last, cell of a way that it searched from start to goal."""
    if any(never_shortened(tree)):
        return  # which says more
    for owner in nodes_of(tree, ast.ClassDef):
        for way in {unparse(target) for target, value in assigned(owner) if _is_a_list(target, value)}:
            makers = [each for each in functions(owner) if each.name != "__init__" and _makes(each, way)]
            if not makers and any(unparse(one) == way and isinstance(of, ast.Call) for one, of in assigned(owner)):
                makers = [each for each in functions(tree) if _follows_back(each)]
            turned = any(called(each) & TURNS_ROUND or "[::-1]" in unparse(each) for each in makers)
            changed = any(unparse(call.func) in {f"{way}.{name}" for name in SHORTENS} for call, name in calls(owner))
            cut = any(f"{way}[1:]" in unparse(each) or "[1:]" in unparse(each) for each in functions(owner))
            read = [
                node
                for node in nodes_of(owner, ast.Subscript)
                if unparse(node.value) == way and isinstance(node.ctx, ast.Load)
            ]
            kinds = {unparse(node.slice) for node in read}
            looped = any(unparse(each.iter) == way for each in nodes_of(owner, ast.For))
            if not makers or not turned or changed or cut or len(kinds) != 1 or looped:
                continue
            if kinds == {"0"}:
                yield (
                    read[0],
                    f"{way}[0] is the first cell of the way, in which the robot stands already, so it has no "
                    "direction to steer to: steer to a cell further along, and take out those that are reached",
                )
            elif kinds == {"-1"}:
                yield (
                    read[0],
                    f"{way}[-1] is the end of the way, and the robot steers straight to it, through what the way goes "
                    "round: follow the cells of the way one after another",
                )


def _is_a_list(target: ast.expr, value: ast.expr) -> bool:
    return isinstance(target, ast.Attribute) and isinstance(value, ast.List) and not value.elts


def _makes(function: ast.FunctionDef, way: str) -> bool:
    """Return whether a function collects a way back from its goal: `cell = before[cell]` in a loop."""
    return any(unparse(target) == way for target, _ in assigned(function)) and _follows_back(function)


def _follows_back(function: ast.FunctionDef) -> bool:
    return bool(called(function) & COLLECTS) and any(
        isinstance(value, ast.Subscript) and unparse(value.slice) == unparse(target)
        for loop in nodes_of(function, ast.While)
        for target, value in assigned(loop)
    )


@suspicion_of(About.WAY, ast.While, ast.If)
def other_end_taken(node: ast.While | ast.If) -> Words:
    """Find `self.way.pop()` after a test of `self.way[0]`: the last cell is taken out, not the one that is reached."""
    for call, name in (pair for part in node.body for pair in calls(part)):
        way = unparse(call.func).rpartition(".")[0]
        whole = unparse(node.test)
        if name == "pop" and not call.args and f"{way}[0]" in whole and f"{way}[-1]" not in whole:
            yield (
                call,
                f"{unparse(call)} takes the last cell out of the way, and `{whole[:50]}` is about the first "
                f"one: {way}.pop(0) takes out what is reached",
            )


@suspicion_of(About.WAY, ast.ClassDef)
def left_in_the_first_pass(owner: ast.ClassDef) -> Words:
    """Find a loop over a way that returns, or breaks, in its first pass whatever the cell is."""
    ways = {unparse(target) for target, value in assigned(owner) if _is_a_list(target, value)}
    for loop in nodes_of(owner, ast.For):
        early = any(isinstance(each, ast.Continue) for each in walk(loop))
        if unparse(loop.iter) in ways and isinstance(loop.body[-1], ast.Return | ast.Break) and not early:
            yield (
                loop,
                f"the loop over {unparse(loop.iter)} ends in its first pass (line {loop.body[-1].lineno}), so "
                "it always takes the first cell of the way, in which the robot stands: a condition must say which "
                "cell is far enough",
            )
