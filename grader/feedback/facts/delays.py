"""What delays the first message of a node: the periods of its timers, and the sleeps with a constant length.

A kind of submission that is Python records them as facts; a check that sees a message at the wrong moment adds them up.
"""

from __future__ import annotations

import ast
from collections.abc import Mapping
from typing import Any

from gz_course.grader.feedback.facts.constants import Number, named_numbers, number
from gz_course.grader.feedback.facts.syntax import Places, calls, left_early, nodes_of, places_in, unparse, walk

MOST = 4  # delays of a file; with more, nobody knows which of them count
SLEEPS = frozenset({"sleep"})


def delays(content: bytes) -> Places:
    """Return `line`, `kind` (`timer` or `sleep`) and `seconds` of each delay; none if there are too many.

    A sleep in a loop of a constant number of rounds has its `rounds`.
    """
    return places_in(content, _delays)


def _delays(tree: ast.Module) -> Places:
    numbers = named_numbers(tree)
    rounds = {
        id(inner): times
        for loop in nodes_of(tree, ast.For)
        if (times := _rounds(loop, numbers))
        for inner in walk(loop)
    }
    loops = {
        id(inner) for loop in nodes_of(tree, ast.While, ast.For) for inner in walk(loop) if id(inner) not in rounds
    }
    found: list[dict[str, Any]] = []
    for call, name in calls(tree):
        if id(call) in loops or name not in SLEEPS | {"create_timer"}:
            continue
        given = call.args[0] if call.args else next((each.value for each in call.keywords), None)
        seconds = number(given, numbers)
        if seconds is None:
            return []
        kind = "timer" if name == "create_timer" else "sleep"
        found.append({"line": call.lineno, "kind": kind, "seconds": float(seconds), "rounds": rounds.get(id(call), 1)})
    found.sort(key=lambda place: place["line"])
    return found if len(found) <= MOST else []


def _rounds(loop: ast.For, numbers: Mapping[str, Number]) -> int:
    """Return how often a `for ... in range(N)` runs; 0 for other loops, and for one that may be left."""
    counted = loop.iter if isinstance(loop.iter, ast.Call) and unparse(loop.iter.func) == "range" else None
    times = number(counted.args[0], numbers) if counted is not None and len(counted.args) == 1 else None
    left = left_early(loop)
    return int(times) if times and not left else 0
