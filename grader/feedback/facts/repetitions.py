"""What publishes again in a Python file: a timer that is made twice though one is cancelled, and a loop.

A kind of submission that is Python records them as facts; a check that sees too many messages names
them.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Place, Places, calls, functions, last_name, nodes_of, places_in, walk

MOST = 2  # places reported at most


def repetitions(content: bytes) -> Places:
    """Return `line` and `said`, the words of a sentence, of each such place."""
    looks = (_timers, _loops)
    return places_in(
        content, lambda tree: [{"line": line, "said": said} for look in looks for line, said in look(tree)][:MOST]
    )


def _timers(tree: ast.Module) -> Iterator[Place]:
    for function in functions(tree):
        timers = [call for call, name in calls(function) if name == "create_timer" and _callback(call)]
        if not timers or function.name == "__init__":
            continue
        called = sorted(call.lineno for call, name in calls(tree) if name == function.name)
        callback = _callback(timers[0])
        if len(called) > 1:
            yield (
                timers[0].lineno,
                f"{function.name}() makes a timer here, and lines {called[0]} and {called[1]} call it: two timers call "
                f"{callback}, and cancel() ends only the one that was made last",
            )


def _loops(tree: ast.Module) -> Iterator[Place]:
    """Find a loop that publishes in every iteration and has no end of its own, or a constant number of rounds."""
    for loop in nodes_of(tree, ast.While, ast.For):
        inside = [call.lineno for statement in loop.body for call, name in calls(statement) if name == "publish"]
        if inside and not any(isinstance(each, ast.Break | ast.Return | ast.FunctionDef) for each in walk(loop)):
            yield loop.lineno, f"this loop comes to publish() in line {inside[0]} again in each of its rounds"


def _callback(timer: ast.Call) -> str:
    """Return the name of the function that a timer calls; empty if it has none."""
    given = next((each.value for each in timer.keywords if each.arg == "callback"), None)
    if given is None and len(timer.args) > 1:
        given = timer.args[1]
    return last_name(given) if given is not None else ""
