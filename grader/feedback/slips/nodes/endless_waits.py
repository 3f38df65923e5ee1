"""Waits without an end: for another callback, for a lock that is held, in a loop that goes on after Ctrl-C."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import (
    Place,
    Words,
    assigned,
    called,
    calls,
    functions,
    last_name,
    nodes_of,
    unparse,
    walk,
)
from gz_course.grader.feedback.slips import slip, slip_of
from gz_course.grader.feedback.slips.nodes.scan_callbacks import callbacks

ENDS = frozenset({"BaseException", "KeyboardInterrupt"})
LEAVES = ast.Break | ast.Return | ast.Raise
EXITS = frozenset({"exit", "_exit", "quit", "abort"})
THREADS = frozenset({"Thread", "start_new_thread", "MultiThreadedExecutor", "ThreadPoolExecutor", "Process"})
PROGRESS = frozenset({
    "spin_once", "spin_some", "now", "time", "monotonic", "perf_counter", "pop", "popleft", "append", "clear", "remove",
    "next", "heappop", "get", "sleep",
})  # fmt: skip


@slip_of(ast.While)
def never_ends(loop: ast.While) -> Words:
    """Find `while True` with a `try` inside that spins, catches KeyboardInterrupt and goes on."""
    if not isinstance(loop.test, ast.Constant) or not loop.test.value:
        return
    for node in nodes_of(loop, ast.Try):
        spins = any(name.startswith("spin") for part in node.body for name in called(part))
        for handler in node.handlers if spins else ():
            if not _catches(handler):
                continue
            leaves = any(isinstance(each, LEAVES) for each in walk(handler)) or called(handler) & EXITS
            if not leaves and not _asks_whether_ok(loop):
                caught = unparse(handler.type) if handler.type else "without a name"
                yield (
                    handler,
                    f"this except ({caught}) catches the KeyboardInterrupt of Ctrl-C, and the loop of line "
                    f"{loop.lineno} goes on, so the program never ends: leave the loop here with break",
                )
            break


def _catches(handler: ast.ExceptHandler) -> bool:
    """Return whether a handler is the one that gets a KeyboardInterrupt."""
    if handler.type is None:
        return True
    return any(isinstance(each, ast.Name) and each.id in ENDS for each in walk(handler.type))


def _asks_whether_ok(loop: ast.While) -> bool:
    tests = [node.test for node in nodes_of(loop, ast.If)]
    return any("ok" in called(test) for test in tests)


@slip
def spins_too_little(tree: ast.AST) -> Iterator[Place]:
    """Find a program with callbacks that calls spin_once() outside of every loop, or nothing that spins."""
    names = called(tree)
    made = [call for call, name in calls(tree) if name in ("create_timer", "create_subscription")]
    programs = "init" in names and made
    if not programs or any(name.startswith("spin") and name != "spin_once" for name in names):
        return
    if "spin_once" not in names:
        if "spin" not in unparse(tree):
            yield (
                made[0].lineno,
                "nothing in this file spins the node, so this callback never runs: rclpy.spin(node) comes after the "
                "node is made",
            )
        return
    loops = [node for node in nodes_of(tree, ast.While, ast.For)]
    looped = {name for loop in loops for name in called(loop)}
    spinning = {node.name for node in nodes_of(tree, ast.FunctionDef) if "spin_once" in called(node)}
    if not looped & (spinning | {"spin_once"}):
        yield (
            next(call.lineno for call, name in calls(tree) if name == "spin_once"),
            "spin_once() waits for one event and returns, so the program ends after the first: rclpy.spin(node) stays "
            "until Ctrl-C",
        )


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


def _taken(function: ast.FunctionDef, locks: set[str]) -> Iterator[tuple[str, ast.With]]:
    for node in nodes_of(function, ast.With):
        for item in node.items:
            if (name := unparse(item.context_expr)) in locks:
                yield name, node


@slip
def taken_twice(tree: ast.AST) -> Iterator[Place]:
    """Find a function that is called while a Lock is held, and that takes the same Lock."""
    locks = {
        unparse(target)
        for target, value in assigned(tree)
        if isinstance(value, ast.Call) and last_name(value.func) == "Lock"
    }
    takers = {(function.name, name) for function in functions(tree) for name, _ in _taken(function, locks)}
    classes = [node for node in nodes_of(tree, ast.ClassDef)]
    methods = {function.name for owner in classes for function in owner.body if isinstance(function, ast.FunctionDef)}
    for function in functions(tree):
        for lock, held in _taken(function, locks):
            for part in held.body:
                for call, name in calls(part):
                    # A method is called by self.NAME(); a local variable may have the same name.
                    own = f"self.{name}" if name in methods else name
                    if unparse(call.func) == own and (name, lock) in takers:
                        yield (
                            call.lineno,
                            f"{unparse(call.func)}() takes {lock}, which line {held.lineno} holds already, so it "
                            "waits for ever: a Lock can be taken once only, an RLock again by the same thread",
                        )
                        return
