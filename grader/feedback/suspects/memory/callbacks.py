"""Suspects in callbacks: errors that are hidden, sleeps in which a node hears nothing, lookups the wrong way."""

from __future__ import annotations

import ast

from gz_course.grader.feedback.facts.syntax import (
    Words,
    assigned,
    called,
    calls,
    functions,
    hands_over,
    last_name,
    nodes_of,
    unparse,
    walk,
)
from gz_course.grader.feedback.slips.nodes.scan_callbacks import callbacks
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

ANY_ERROR = ("", "Exception", "BaseException", "TypeError", "AttributeError", "NameError", "ValueError", "IndexError")
SAYING = frozenset({"error", "warning", "warn", "fatal", "info", "print", "print_exc", "exception"})
LOOPS = frozenset({"spin", "spin_once", "shutdown"})
LOOKUPS = frozenset({"lookup_transform", "transform", "wait_for_transform"})
SLEEPS = frozenset({"sleep", "sleep_for", "sleep_until"})
CLOCKS = frozenset({"now", "time", "monotonic", "perf_counter", "time_ns", "monotonic_ns"})
THREADS = frozenset({"Thread", "start_new_thread", "MultiThreadedExecutor", "ThreadPoolExecutor", "Process"})
SHORT = 0.05  # [s] of sleep that hardly delays anything


@suspicion_of(About.HIDDEN)
def hidden(tree: ast.AST) -> Words:
    """Find a handler that goes on after any error, or after one of the programmer's, and says nothing of it."""
    for node in walk(tree):
        inside = {name for statement in node.body for name in called(statement)} if isinstance(node, ast.Try) else LOOPS
        if not isinstance(node, ast.Try) or inside & LOOPS:
            continue
        lines = f"{node.body[0].lineno} to {node.body[-1].end_lineno}"
        for handler in node.handlers:
            kind = unparse(handler.type) if handler.type is not None else ""
            again = any(isinstance(each, ast.Raise) for each in walk(handler))
            known = last_name(handler.type) if handler.type is not None else ""
            if known not in ANY_ERROR or called(handler) & SAYING or again:
                continue
            way = "take it away" if not inside & LOOKUPS else "catch only what you expect, TransformException"
            said = f"{f'except {kind}'.strip()}: hides the errors of lines {lines}; {way}, and Python names the error"
            yield handler, said


@suspicion_of(About.EXCHANGED_FRAMES)
def exchanged(tree: ast.AST) -> Words:
    """Find a lookup whose target is the frame of a message, and whose source is not."""
    frames = {unparse(target) for target, value in assigned(tree) if unparse(value).endswith("header.frame_id")}
    for call, name in calls(tree):
        given = {each.arg: each.value for each in call.keywords} | dict(
            zip(("target_frame", "source_frame"), call.args, strict=False)
        )
        if name != "lookup_transform" or not {"target_frame", "source_frame"} <= given.keys():
            continue
        target, source = (unparse(given[each]) for each in ("target_frame", "source_frame"))
        of_a_message = [each in frames or each.endswith("header.frame_id") for each in (target, source)]
        if of_a_message == [True, False]:
            yield (
                call,
                f"lookup_transform({target}, {source}, ...): the frame into which points are taken comes first, that "
                "of the message second; here they are exchanged, which gives the inverse",
            )


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
