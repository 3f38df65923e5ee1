"""Misuse of tf2 that raises no error of its own, or one that is caught; used by exercises on frames.

`LOOKS` find what is wrong in every system. `lookups` returns what a file asks tf2 for; whether that exists, and when it
comes, only the recording knows.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import Any

from gz_course.grader.feedback.facts.syntax import (
    Place,
    Places,
    Words,
    called,
    calls,
    functions,
    last_name,
    nodes_of,
    places_in,
    unparse,
    walk,
)
from gz_course.grader.feedback.slips import slip, slip_of
from gz_course.grader.feedback.slips.nodes.scan_callbacks import callbacks

ASKED = frozenset({"lookup_transform", "can_transform"})
SPINS = frozenset({"spin", "spin_once", "spin_until_future_complete"})
KEEPS = frozenset({"append", "appendleft", "put", "add", "insert", "extend"})
MOST = 4  # lookups that are recorded


def _threads(tree: ast.AST) -> bool:
    """Return whether more than one thread may run callbacks."""
    return any(
        name in ("MultiThreadedExecutor", "Thread") or "spin_thread" in [each.arg for each in call.keywords]
        for call, name in calls(tree)
    )


@slip
def new_buffers(tree: ast.AST) -> Iterator[Place]:
    """Find a buffer, or a listener, that a callback makes anew each time."""
    handed = callbacks(tree)
    for function in functions(tree):
        if function.name not in handed:
            continue
        guarded = {id(inner) for node in nodes_of(function, ast.If) for inner in walk(node)}
        for call, name in calls(function):
            if name in ("Buffer", "TransformListener") and id(call) not in guarded:
                yield (
                    call.lineno,
                    f"the callback {function.name} makes a new {name} each time, which has heard no "
                    "transform yet: make buffer and listener once, in __init__",
                )
                break


@slip
def no_listener(tree: ast.AST) -> Iterator[Place]:
    """Find a buffer that nothing fills."""
    names = {node.id for node in nodes_of(tree, ast.Name)}
    names |= {node.attr for node in nodes_of(tree, ast.Attribute)}
    if "Buffer" not in names or not names & ASKED or names & {"TransformListener", "set_transform"}:
        return
    for call, name in calls(tree):
        if name == "Buffer":
            yield (
                call.lineno,
                "nothing fills this buffer: TransformListener(buffer, node) hears /tf and /tf_static and puts the "
                "transforms into it",
            )


@slip
def waiting_loops(tree: ast.AST) -> Iterator[Place]:
    """Find a loop that waits for a transform while nothing in the node can hear one, and spinning in a callback."""
    if _threads(tree):
        return
    handed = callbacks(tree)
    for function in functions(tree):
        spins = [call for call, name in calls(function) if function.name in handed and name in SPINS]
        for call in (each for each in spins if unparse(each.func).startswith("rclpy.")):
            yield (
                call.lineno,
                f"{unparse(call.func)}() in the callback {function.name}: a callback is called by spin(), and "
                "inside of it the node cannot be spun again; return, and try again in the next call",
            )
        for node in nodes_of(function, ast.While):
            if function.name in ("main", "__init__"):
                continue
            asks = any(name in ASKED for call, name in calls(node))
            if asks and not any(name in SPINS for call, name in calls(node)) and _endless(node):
                yield (
                    node.lineno,
                    "this loop waits for a transform in the only thread of the node: while it runs, no transform is "
                    "heard, so it never ends; return, and try again in the next call",
                )


def _endless(loop: ast.While) -> bool:
    """Return whether a loop goes on until it gets a transform, and ends for no other reason."""
    if any(name in ASKED for call, name in calls(loop.test)):
        return True
    tries = [
        each
        for each in nodes_of(loop, ast.Try)
        if any(name in ASKED for statement in each.body for call, name in calls(statement))
    ]
    if not isinstance(loop.test, ast.Constant) or not tries:
        return False
    begin = min(each.lineno for each in tries)
    handled = {id(node) for each in tries for handler in each.handlers for node in walk(handler)}
    ends = (node for node in walk(loop) if isinstance(node, ast.Break | ast.Return | ast.Raise))
    return not any(node.lineno < begin or id(node) in handled for node in ends)


@slip_of(ast.FunctionDef)
def of_this_moment(function: ast.FunctionDef) -> Words:
    """Find a lookup at the time now, for data that came now: its transform cannot have come yet."""
    if not {each.arg for each in function.args.args} - {"self"}:
        return  # a timer may be called when a transform has just come
    now = {unparse(node.targets[0]) for node in nodes_of(function, ast.Assign) if _is_now(node.value)}
    for call, time in _lookups(function):
        if time is not None and (_is_now(time) or unparse(time) in now) and len(call.args) <= 3:
            yield (
                call,
                f"{last_name(call.func)}() asks for the transform of this very moment, now(), which has not come "
                "yet when it is asked for: the time belongs to the data, as in Time.from_msg(msg.header.stamp)",
            )


@slip
def other_time_asked_first(tree: ast.AST) -> Iterator[Place]:
    """Find can_transform() of the latest transform before a lookup, not in a try, at the time of a message."""
    tried = {id(n) for each in nodes_of(tree, ast.Try) for part in each.body for n in walk(part)}
    asked: list[tuple[ast.Call, ast.expr | None]] = []
    looked: list[tuple[ast.Call, ast.expr | None]] = []
    for call, time in _lookups(tree):
        (asked if last_name(call.func) == "can_transform" else looked).append((call, time))
    latest = [call for call, time in asked if time is not None and _is_latest(time)]
    at_a_time = [call for call, time in looked if time is not None and not _is_latest(time) and id(call) not in tried]
    if not latest or not at_a_time or len(latest) < len(asked) or len(at_a_time) < len(looked):
        return
    if _source(latest[0]) == _source(at_a_time[0]):
        yield (
            latest[0].lineno,
            f"can_transform() asks here for the latest transform, Time(), and line {at_a_time[0].lineno} looks up that "
            "of another time, which may not be there yet, or no more: ask both for the same time",
        )


def _source(call: ast.Call) -> str:
    return last_name(call.args[1]) or unparse(call.args[1]) if len(call.args) > 1 else ""


def _is_latest(node: ast.expr) -> bool:
    return isinstance(node, ast.Call) and last_name(node.func) == "Time" and not node.args and not node.keywords


@slip
def into_itself(tree: ast.AST) -> Iterator[Place]:
    """Find a lookup whose two frames are the same expression."""
    for call, _ in _lookups(tree):
        if len(call.args) >= 2 and unparse(call.args[0]) == unparse(call.args[1]):
            yield (
                call.lineno,
                f"both frames of this lookup are {unparse(call.args[0])[:40]}, so its transform changes nothing: "
                "the first is the frame in which the result is wanted, the second that of the data",
            )


def _is_now(node: ast.expr) -> bool:
    text = unparse(node)
    return text.endswith((".now()", ".now().to_msg()"))


def _lookups(tree: ast.AST) -> Iterator[tuple[ast.Call, ast.expr | None]]:
    """Yield each call that asks tf2 for a transform, with its time."""
    for call, name in calls(tree):
        if name in ASKED:
            time = call.args[2] if len(call.args) > 2 else None
            yield call, next((each.value for each in call.keywords if each.arg == "time"), time)


def lookups(content: bytes) -> Places:
    """Return `line`, the `frames` that are written down and whether the node `gives_up`, of each lookup.

    A node gives up if it asks for the transform of a message's stamp and keeps the messages nowhere to ask again.
    """
    return places_in(content, lambda tree: list(_asked_for(tree))[:MOST])


def _asked_for(tree: ast.Module) -> Iterator[dict[str, Any]]:
    constants = {
        unparse(node.targets[0]): node.value.value
        for node in nodes_of(tree, ast.Assign)
        if isinstance(node.value, ast.Constant)
    }
    gives_up = not _keeps_messages(tree) and not _threads(tree)
    for call, time in _lookups(tree):
        named = [each.value for each in call.keywords if each.arg in ("target_frame", "source_frame")]
        frames = _texts([*call.args[:2], *named], constants)
        found = {"line": call.lineno, "frames": frames, "gives_up": gives_up and _of_a_stamp(tree, time)}
        altered = next((text for each in [*call.args[:2], *named] if (text := _altered(each))), "")
        yield found | ({"altered": altered} if altered else {})
    for call, name in calls(tree):
        if name == "transform" and "buf" in unparse(call.func).lower() and call.args:
            yield {"line": call.lineno, "frames": _texts(call.args[1:2], constants), "gives_up": gives_up}


def _altered(node: ast.expr) -> str:
    """Return an expression that takes a part of a frame_id, more than its first slash; empty for any other."""
    if isinstance(node, ast.Call | ast.Subscript | ast.BinOp) and ".frame_id" in (text := unparse(node)):
        return "" if "strip('/')" in text else text[:60]
    return ""


def _texts(nodes: list[ast.expr], constants: dict[str, Any]) -> list[str]:
    values = [each.value if isinstance(each, ast.Constant) else constants.get(unparse(each)) for each in nodes]
    return [value for value in values if isinstance(value, str)]


def _of_a_stamp(tree: ast.AST, time: ast.expr | None) -> bool:
    texts = [] if time is None else [unparse(time)]
    for node in walk(tree):
        if texts and isinstance(node, ast.Assign) and unparse(node.targets[0]) == texts[0]:
            texts.append(unparse(node.value))
    return any("header.stamp" in text for text in texts)


def _keeps_messages(tree: ast.AST) -> bool:
    """Return whether a function puts what it is called with into an attribute, or into a list that outlives it.

    A timer that asks has its message from there, too.
    """
    timers = callbacks(tree, ("create_timer",))
    if any(each.name in timers and called(each) & (ASKED | {"transform"}) for each in functions(tree)):
        return True
    if callbacks(tree) & KEEPS or any(isinstance(node, ast.Await) for node in walk(tree)):
        return True
    for function in functions(tree):
        given = {each.arg for each in function.args.args} - {"self"}
        for node in walk(function):
            if _asked_at_once(tree, function, node, given):
                continue
            kept = isinstance(node, ast.Call) and last_name(node.func) in KEEPS and "." in unparse(node.func)
            kept |= isinstance(node, ast.Assign) and any(
                isinstance(each, ast.Attribute) and unparse(each).startswith("self.") for each in walk(node.targets[0])
            )
            if kept and given & {each.id for each in nodes_of(node, ast.Name)}:
                return True
    return False


def _asked_at_once(tree: ast.AST, function: ast.FunctionDef, node: ast.AST, given: set[str]) -> bool:
    """Return whether a callback puts its message into an attribute from which only its own lookup takes it."""
    handed, subscribed = callbacks(tree), callbacks(tree, ("create_subscription",))
    plain = isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Attribute)
    if not isinstance(node, ast.Assign) or not plain or node not in function.body or function.name not in subscribed:
        return False
    kept = unparse(node.targets[0])
    if unparse(node.value) not in given:
        return False
    before = any(
        isinstance(each, ast.Attribute) and unparse(each) == kept and each.lineno < node.lineno
        for each in walk(function)
    )
    asking = [each for each in functions(tree) if any(name in ASKED for _, name in calls(each))]
    later = {name for call, name in calls(function) if call.lineno > node.lineno}
    return not before and all(each is function or (each.name in later and each.name not in handed) for each in asking)


def shared_headers(content: bytes) -> Places:
    """Return the `line` of each change of a frame_id in a header that is that of another message, too."""
    return places_in(content, lambda tree: [{"line": line} for line in _shared(tree)][:MOST])


def _shared(tree: ast.Module) -> Iterator[int]:
    for function in functions(tree):
        assigned = [node for node in nodes_of(function, ast.Assign)]
        same = {
            unparse(node.targets[0])
            for node in assigned
            if unparse(node.targets[0]).endswith(".header") and unparse(node.value).endswith(".header")
        }
        yield from (
            node.lineno
            for node in assigned
            if unparse(node.targets[0]).removesuffix(".frame_id") in same
            and unparse(node.targets[0]).endswith(".frame_id")
        )
