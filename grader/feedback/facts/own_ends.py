"""Where a program ends by itself: what ends it, or its spinning, before Ctrl-C does.

It is named only if the program has ended (exit code 0) before its run.

Source: rclpy.executors.Executor.spin, which returns when the context is shut down and passes SystemExit on
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import (
    Place,
    Places,
    called,
    calls,
    children,
    functions,
    last_name,
    nodes_of,
    places_in,
    unparse,
    walk,
)

EXITS = frozenset({"exit", "_exit", "quit", "abort", "kill"})
RAISED = frozenset({"SystemExit", "KeyboardInterrupt", "ExternalShutdownException"})
SHUTS = frozenset({"shutdown", "try_shutdown"})
SPINS = frozenset({"spin", "spin_once", "spin_until_future_complete"})


def own_ends(content: bytes) -> Places:
    """Return `line` and `said`, the words of a sentence, of each place; nothing if the file is not Python."""
    return places_in(content, lambda tree: [{"line": line, "said": said} for line, said in _ends(tree)])


def _ends(tree: ast.AST) -> Iterator[Place]:
    """Find what ends a program in a function that does not spin, and spinning that ends without Ctrl-C."""
    for function in functions(tree):
        if called(function) & SPINS or function.name in ("main", "destroy_node", "__exit__", "on_shutdown"):
            yield from _spins_for_a_while(function)
            continue
        for node in walk(function):
            if what := _end(node):
                line = node.lineno  # type: ignore[attr-defined]
                yield line, f"`{what}` in {function.name}() ends the program: nothing runs after it"


def _end(node: ast.AST) -> str:
    """Return the code of a statement that ends the program; empty if it does not."""
    if isinstance(node, ast.Raise) and node.exc is not None:
        raised = node.exc.func if isinstance(node.exc, ast.Call) else node.exc
        return unparse(node) if last_name(raised) in RAISED else ""
    if not isinstance(node, ast.Call):
        return ""
    owner = unparse(node.func).rpartition(".")[0]
    name = last_name(node.func)
    if (name in EXITS and owner in ("", "sys", "os")) or (name in SHUTS and (owner == "rclpy" or "context" in owner)):
        return unparse(node)
    return unparse(node) if name in SHUTS and "executor" in owner else ""


def _spins_for_a_while(function: ast.FunctionDef) -> Iterator[Place]:
    """Find a loop of spin_once() that ends, or spinning until a future is done."""
    for loop in nodes_of(function, ast.While, ast.For):
        if not called(loop) & SPINS:
            continue
        left = next((each for part in loop.body for each in _leaves(part)), None)
        if left is not None:
            what = "break" if isinstance(left, ast.Break) else unparse(left)
            yield left.lineno, f"this {what} ends the loop of line {loop.lineno}, which spins, and the program"
        test = unparse(loop.test) if isinstance(loop, ast.While) else ""
        if test not in ("True", "1", "rclpy.ok()"):
            said = f"`while {test}`" if test else "this loop"
            yield loop.lineno, f"{said} ends, and what spins in it: then the program is over"
    for call, name in calls(function):
        if name == "spin_until_future_complete" and _is_last(function, call):
            code = unparse(call)[:70]
            yield call.lineno, f"`{code}` spins until the future is done; then the program is over"


def _leaves(part: ast.AST) -> Iterator[ast.Break | ast.Return | ast.Raise]:
    """Yield what leaves a loop, but not from inside of `except` or of another loop or function."""
    if isinstance(part, ast.Break | ast.Return) or (isinstance(part, ast.Raise) and part.exc is not None):
        yield part
    elif not isinstance(part, ast.ExceptHandler | ast.While | ast.For | ast.FunctionDef):
        for child in children(part):
            yield from _leaves(child)


def _is_last(function: ast.FunctionDef, call: ast.Call) -> bool:
    """Return whether nothing spins after a call, in the function."""
    return not any(name in SPINS and each.lineno > call.lineno for each, name in calls(function))
