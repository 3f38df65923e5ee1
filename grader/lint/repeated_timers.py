"""Timers of a Python file of which there is more than one, although one is cancelled: each calls its callback.

A kind of submission that is Python records them as facts; a check that sees too many messages names them.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.lint.syntax import Place, Places, calls, functions, last_name, places_in

MOST = 2  # places reported at most


def repeated_timers(content: bytes) -> Places:
    """Return `line` and `said`, the words of a sentence, of each timer that is made more than once."""
    return places_in(content, lambda tree: [{"line": line, "said": said} for line, said in _repeated(tree)][:MOST])


def _repeated(tree: ast.Module) -> Iterator[Place]:
    made: dict[str, list[int]] = {}
    for call, name in calls(tree):
        if name == "create_timer" and (callback := _callback(call)):
            made.setdefault(callback, []).append(call.lineno)
    for callback, lines in made.items():
        if len(lines) > 1:
            first, second = sorted(lines)[:2]
            yield (
                second,
                f"a second timer that calls {callback} is made here, beside that of line {first}: both publish",
            )
    for function in functions(tree):
        timers = [call for call, name in calls(function) if name == "create_timer" and _callback(call)]
        if not timers or function.name == "__init__":
            continue
        called = sorted(call.lineno for call, name in calls(tree) if name == function.name)
        callback = _callback(timers[0])
        if callback == function.name:
            yield (
                timers[0].lineno,
                f"each call of {callback} makes another timer here, and the one before goes on: a timer calls again "
                "and again by itself",
            )
        elif len(called) > 1:
            yield (
                timers[0].lineno,
                f"{function.name}() makes a timer here, and lines {called[0]} and {called[1]} call it: two timers call "
                f"{callback}, and cancel() ends only the one that was made last",
            )


def _callback(timer: ast.Call) -> str:
    """Return the name of the function that a timer calls; empty if it has none."""
    given = next((each.value for each in timer.keywords if each.arg == "callback"), None)
    if given is None and len(timer.args) > 1:
        given = timer.args[1]
    return last_name(given) if given is not None else ""
