"""Loops around spin() that go on after Ctrl-C, and programs that spin once, or not at all."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Place, Words, called, calls, nodes_of, unparse, walk
from gz_course.grader.feedback.slips import slip, slip_of

ENDS = frozenset({"BaseException", "KeyboardInterrupt"})
LEAVES = ast.Break | ast.Return | ast.Raise
EXITS = frozenset({"exit", "_exit", "quit", "abort"})


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
