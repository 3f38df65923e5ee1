"""Suspects in feedback that comes too seldom: outside of the loop that drives, or under a condition in it."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Words, called, calls, functions, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

Loop = ast.While | ast.For | ast.AsyncFor
SENDS = "publish_feedback"
CLOCK = re.compile(r"nanosec|now|time|monotonic|Duration")  # a condition on the time is a rate, and may be right
STEPS = frozenset({"publish"})  # what a round of a loop that drives does; one that only sleeps waits


def _reaching(tree: ast.AST, names: frozenset[str]) -> set[str]:
    """Return names, and those of the functions that call one of them, themselves or by another function."""
    found, own = set(names), list(functions(tree))
    for _ in own:
        more = {each.name for each in own if called(each) & found} - found
        if not more:
            break
        found |= more
    return found


def _drivers(tree: ast.AST, node: ast.AST) -> Iterator[Loop]:
    """Yield the innermost loops that drive, in a node and in the functions that it calls."""
    places = [node, *(each for each in functions(tree) if each.name in called(node))]
    steps = _reaching(tree, STEPS)
    for place in places:
        for loop in (each for each in walk(place) if isinstance(each, Loop)):
            inner = [each for each in walk(loop) if isinstance(each, Loop) and each is not loop]
            if called(loop) & steps and not any(called(each) & steps for each in inner):
                yield loop


@suspicion_of(About.RARE_FEEDBACK)
def outside_of_the_loop(tree: ast.AST) -> Words:
    """Find feedback beside the loop that drives, where no loop that drives sends any."""
    if SENDS not in called(tree):
        return
    sending = _reaching(tree, frozenset({SENDS}))
    for function in functions(tree):
        drivers = list(_drivers(tree, function))
        if not drivers or any(called(each) & sending for each in drivers):
            continue
        for call, name in calls(function):
            if name in sending:
                yield call, f"{name}() stands outside of the loop of line {drivers[0].lineno}, which drives the robot"


@suspicion_of(About.RARE_FEEDBACK)
def under_a_condition(tree: ast.AST) -> Words:
    """Find the only call that sends feedback under a condition."""
    sent = [call for call, name in calls(tree) if name == SENDS]
    if len(sent) != 1:
        return
    around = [
        node for node in nodes_of(tree, ast.If) if any(each is sent[0] for part in node.body for each in walk(part))
    ]
    if around and not CLOCK.search(unparse(around[-1].test)):  # the innermost one is walked to last
        yield sent[0], f"{SENDS}() is called only if `{unparse(around[-1].test)[:80]}`"
