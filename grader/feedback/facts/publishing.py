"""When a file publishes: its counters and delays, what publishes again, what is sent before anybody hears it.

A kind of submission that is Python records them as facts; the diagnosis names one only if a check has seen a message
too late, or one too many, by as much as such a counter makes.

A kind of submission that is Python records them as facts; a check that sees a message at the wrong moment adds them up.

A kind of submission that is Python records them as facts; a check that sees too many messages names
them.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from typing import Any

from gz_course.grader.feedback.facts.constants import Number, named_numbers, number
from gz_course.grader.feedback.facts.syntax import (
    Place,
    Places,
    assigned,
    calls,
    children,
    functions,
    last_name,
    left_early,
    nodes_of,
    places_in,
    unparse,
    walk,
)

MOST_COUNTERS = 3  # counters reported at most
MOST_DELAYS = 4  # delays of a file; with more, nobody knows which of them count
SLEEPS = frozenset({"sleep"})
MOST_EARLY = 2  # calls reported at most
WAITS = frozenset({"spin", "spin_once", "spin_until_future_complete", "sleep", "sleep_for", "wait", "wait_for_service"})
Block = ast.Module | ast.FunctionDef
MOST_AGAIN = 2  # places reported at most


def counters(content: bytes) -> Places:
    """Return each comparison of a counter, which begins with 0, above the line that adds 1 to it in its function.

    A place has `line` and `code` of the comparison, the `counter`, the number `limit` and `added`, the line that adds.
    """
    return places_in(content, lambda tree: list(_counters(tree))[:MOST_COUNTERS])


def _counters(tree: ast.Module) -> Iterator[dict[str, Any]]:
    numbers = named_numbers(tree)
    from_zero = {
        unparse(target)
        for target, value in assigned(tree)
        if isinstance(value, ast.Constant) and value.value == 0 and not isinstance(value.value, bool)
    }
    for function in functions(tree):
        for added in nodes_of(function, ast.AugAssign, ast.Assign):
            counter = _increased(added)
            if counter.removeprefix("self.") not in from_zero and counter not in from_zero:
                continue
            for test in nodes_of(function, ast.Compare):
                if len(test.ops) != 1 or test.lineno >= added.lineno:
                    continue
                limit = number(test.comparators[0], numbers)
                if unparse(test.left) == counter and limit is not None:
                    yield {
                        "line": test.lineno,
                        "code": unparse(test)[:80],
                        "counter": counter,
                        "limit": float(limit),
                        "added": added.lineno,
                    }


def _increased(node: ast.AugAssign | ast.Assign) -> str:
    """Return the counter to which a statement adds 1; empty if it is another statement."""
    target = unparse(node.target if isinstance(node, ast.AugAssign) else node.targets[0])
    if isinstance(node, ast.AugAssign) and isinstance(node.op, ast.Add):
        step = node.value
    elif isinstance(node.value, ast.BinOp) and isinstance(node.value.op, ast.Add):
        step = node.value.right if unparse(node.value.left) == target else node.value
    else:
        return ""
    return target if isinstance(step, ast.Constant) and step.value == 1 else ""


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
    return found if len(found) <= MOST_DELAYS else []


def _rounds(loop: ast.For, numbers: Mapping[str, Number]) -> int:
    """Return how often a `for ... in range(N)` runs; 0 for other loops, and for one that may be left."""
    counted = loop.iter if isinstance(loop.iter, ast.Call) and unparse(loop.iter.func) == "range" else None
    times = number(counted.args[0], numbers) if counted is not None and len(counted.args) == 1 else None
    left = left_early(loop)
    return int(times) if times and not left else 0


def early_publishing(content: bytes) -> Places:
    """Return the `line` and the `function` (empty: that of the module) of each such call.

    It stands in `__init__`, in a method that `__init__` calls, or above whatever waits in a function that makes a node.
    """
    return places_in(
        content, lambda tree: [{"line": line, "function": name} for line, name in _early(tree)][:MOST_EARLY]
    )


def _early(tree: ast.Module) -> Iterator[tuple[int, str]]:
    methods = {function.name: function for function in functions(tree)}
    for function in functions(tree):
        if function.name != "__init__":
            continue
        for call, name in _own_calls(function):
            if name in WAITS:
                break
            own = name in methods and _is_of_self(call)
            if name == "publish" or (own and "publish" in _names(methods[name])):
                yield call.lineno, "__init__"
    blocks: list[Block] = [tree, *functions(tree)]
    for block in blocks:
        said = [(call, name) for call, name in _own_calls(block)]
        if not {"create_publisher", "create_node", "init"} & {name for _, name in said}:
            continue
        if isinstance(block, ast.FunctionDef) and block.name == "__init__":
            continue
        for call, name in said:
            if name in WAITS:
                break
            if name == "publish":
                yield call.lineno, getattr(block, "name", "")


def _is_of_self(call: ast.Call) -> bool:
    return isinstance(call.func, ast.Attribute) and last_name(call.func.value) == "self"


def _names(function: ast.FunctionDef) -> set[str]:
    return {name for _, name in calls(function)}


def _own_calls(block: Block) -> list[tuple[ast.Call, str]]:
    """Return the calls of a block in the order of their lines, without those of functions and classes in it."""
    found: list[ast.Call] = []
    todo: list[ast.AST] = list(block.body)
    while todo:
        node = todo.pop()
        if isinstance(node, ast.FunctionDef | ast.ClassDef | ast.Lambda | ast.AsyncFunctionDef):
            continue
        if isinstance(node, ast.Call):
            found.append(node)
        todo += children(node)
    ordered = sorted(found, key=lambda call: (call.lineno, call.col_offset))
    return [(call, last_name(call.func)) for call in ordered]


def repetitions(content: bytes) -> Places:
    """Return `line` and `said`, the words of a sentence, of each such place."""
    looks = (_timers, _loops)
    return places_in(
        content, lambda tree: [{"line": line, "said": said} for look in looks for line, said in look(tree)][:MOST_AGAIN]
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
