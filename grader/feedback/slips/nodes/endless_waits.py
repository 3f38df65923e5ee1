"""Loops in a callback that wait for what only another callback sets: a node with one thread never leaves them."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import (
    Place,
    assigned,
    called,
    calls,
    functions,
    last_name,
    nodes_of,
    unparse,
    walk,
)
from gz_course.grader.feedback.slips import slip
from gz_course.grader.feedback.slips.nodes.scan_callbacks import callbacks

THREADS = frozenset({"Thread", "start_new_thread", "MultiThreadedExecutor", "ThreadPoolExecutor", "Process"})
PROGRESS = frozenset({
    "spin_once", "spin_some", "now", "time", "monotonic", "perf_counter", "pop", "popleft", "append", "clear", "remove",
    "next", "heappop", "get", "sleep",
})  # fmt: skip


@slip
def waits_for_another_callback(tree: ast.AST) -> Iterator[Place]:
    """Find `while abs(goal - self.yaw) > 0.1: publish(...)` in a timer's callback, where /odom's callback sets yaw."""
    if called(tree) & THREADS:
        return
    listening = callbacks(tree, ("create_subscription",))
    own = {each.name: each for each in functions(tree)}
    running = callbacks(tree) | {
        last_name(call.func) for name in callbacks(tree) & own.keys() for call, _ in calls(own[name])
    }
    for function in (own[name] for name in own if name in running):
        heard = {
            unparse(target)
            for name in listening & own.keys()
            if name != function.name
            for target, _ in assigned(own[name])
            if isinstance(target, ast.Attribute)
        }
        setting = {name for name, each in own.items() if any(isinstance(t, ast.Attribute) for t, _ in assigned(each))}
        for loop in nodes_of(function, ast.While):
            if called(loop) & (PROGRESS | setting) or _leaves(loop):
                continue
            changed: dict[str, set[str]] = {}
            for target, value in assigned(loop):
                for each in nodes_of(target, ast.Name, ast.Attribute):
                    changed.setdefault(unparse(each), set()).update(_read(value))
            stepping = {unparse(node.target) for node in nodes_of(loop, ast.AugAssign)}
            tested = _read(loop.test)
            for name in tested & changed.keys():
                tested |= changed[name]
            if tested & heard and not tested & (stepping | heard & changed.keys()) and not _circular(changed, tested):
                name = sorted(tested & heard)[0]
                yield (
                    loop.lineno,
                    f"the loop `while {unparse(loop.test)[:60]}` in the callback {function.name} waits for {name}, "
                    "which only another callback sets, and none runs before this one has returned: it never ends. "
                    "Publish a command and return, and look again in the next call",
                )
                return


def _leaves(loop: ast.While) -> bool:
    return any(isinstance(node, ast.Break | ast.Return | ast.Raise) for node in walk(loop))


def _read(node: ast.AST) -> set[str]:
    return {unparse(each) for each in nodes_of(node, ast.Name, ast.Attribute)} - {"self"}


def _circular(changed: dict[str, set[str]], tested: set[str]) -> bool:
    """Return whether what is tested is computed of what the loop itself changes, as by one step after another."""
    return any(changed[name] & changed.keys() for name in tested & changed.keys())
