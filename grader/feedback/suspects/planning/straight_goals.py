"""Suspects in goals that are the nearest in a straight line, in a file that draws a map and searches no way."""

from __future__ import annotations

import ast
import re

from gz_course.grader.feedback.facts.syntax import (
    Words,
    assigned,
    called,
    calls,
    functions,
    last_name,
    nodes_of,
    unparse,
)
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

NEAREST = frozenset({"min", "argmin", "sorted", "argsort", "sort"})
DISTANCE = re.compile(r"\bhypot\(|\bnorm\(|\bdist(?:ance)?\(|\*\* 2")
TAKES = frozenset({"pop", "popleft", "heappop", "get", "get_nowait"})


@suspicion_of(About.STRAIGHT)
def straight_goals(tree: ast.AST) -> Words:
    """Find the nearest of several cells as the crow flies, where no loop takes cells out of a queue."""
    loops = nodes_of(tree, ast.While, ast.For)
    if any(called(loop) & TAKES and called(loop) & {"append", "heappush", "put", "add"} for loop in loops):
        return
    if "OccupancyGrid" not in unparse(tree):
        return
    if re.search(r"dijkstra|a_?star|bfs|wave|flood|shortest_path|potential", unparse(tree), re.IGNORECASE):
        return
    for function in functions(tree):
        distances = {unparse(target) for target, value in assigned(function) if DISTANCE.search(unparse(value))}
        for call, name in calls(function):
            given = [*call.args, *(each.value for each in call.keywords)]
            if name not in NEAREST or not given:
                continue
            text = " ".join(unparse(each) for each in given)
            keys = [last_name(each.value) for each in call.keywords if each.arg == "key"]
            own = any(one.name in keys and DISTANCE.search(unparse(one)) for one in functions(tree))
            if "ranges" not in text and (DISTANCE.search(text) or text in distances or own):
                yield (
                    call,
                    f"{unparse(call)[:60]} takes the goal that is nearest in a straight line, and nothing searches "
                    "a way to it: a wall may stand between; search through free cells, breadth first",
                )
