"""Suspects in callbacks that wait: while one sleeps, or runs a loop until a time has come, the node hears nothing."""

from __future__ import annotations

import ast

from gz_course.grader.feedback.facts.syntax import (
    Words,
    called,
    calls,
    functions,
    hands_over,
    last_name,
    nodes_of,
    unparse,
)
from gz_course.grader.feedback.slips.nodes.scan_callbacks import callbacks
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

SLEEPS = frozenset({"sleep", "sleep_for", "sleep_until"})
CLOCKS = frozenset({"now", "time", "monotonic", "perf_counter", "time_ns", "monotonic_ns"})
THREADS = frozenset({"Thread", "start_new_thread", "MultiThreadedExecutor", "ThreadPoolExecutor", "Process"})
SHORT = 0.05  # [s] of sleep that hardly delays anything


@suspicion_of(About.SLEEP)
def sleeping_callbacks(tree: ast.AST) -> Words:
    """Find a sleep, or a loop until a time, in a callback or in a function of the file that one calls."""
    if called(tree) & THREADS:
        return
    for function in reached(tree):
        for call, name in calls(function):
            value = call.args[0].value if call.args and isinstance(call.args[0], ast.Constant) else None
            if name not in SLEEPS or (isinstance(value, int | float) and value < SHORT):
                continue
            yield (
                call,
                f"{unparse(call)[:60]} sleeps in a callback ({function.name}): meanwhile the node hears no scan "
                "and no odometry, and no timer fires, so it continues with old values; publish a command and return, "
                "and look again in the next call",
            )
        for loop in nodes_of(function, ast.While):
            if hands_over(loop):
                continue
            if called(loop.test) & CLOCKS and not called(loop) & (SLEEPS | {"spin_once"}):
                yield (
                    loop,
                    f"the loop `while {unparse(loop.test)[:60]}` waits in a callback ({function.name}): meanwhile "
                    "the node hears nothing, and no timer fires; return, and look again in the next call",
                )


def reached(tree: ast.AST) -> list[ast.FunctionDef]:
    """Return the functions that timers and subscriptions call, and those of the file that these call."""
    own = {each.name: each for each in functions(tree)}
    names, found = list(callbacks(tree)), dict[str, ast.FunctionDef]()
    while names:
        name = names.pop()
        if name in own and name not in found:
            found[name] = own[name]
            names += [
                last_name(call.func)
                for call, _ in calls(own[name])
                if isinstance(call.func, ast.Name) or unparse(call.func).startswith("self.")
            ]
    return list(found.values())
