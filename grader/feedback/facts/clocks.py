"""The places where a file reads the wall clock, or reckons simulated time in a way that goes wrong.

A kind of submission that is Python records these places as facts of a run. The diagnosis mentions them only if a check
saw the right thing at the wrong time (`grader/score/clocks.py`).

Kinds of submissions that are Python record these places as facts of a run. The diagnosis mentions them only if a check
saw the right thing at the wrong time (`grader/score/clocks.py`), because a node may well measure its own speed.
"""

from __future__ import annotations

import ast
from typing import Any

from gz_course.grader.feedback.facts.syntax import Places, nodes_of, places_in, unparse, walk

MOST_RECKONED = 3  # places reported at most
CLOCKS = frozenset({"get_clock", "stamp", "clock", "monotonic", "time", "Clock", "nanoseconds"})
ASKED = frozenset(
    f"time.{name}{unit}" for name in ("time", "monotonic", "perf_counter", "process_time") for unit in ("", "_ns")
)
WAITED = frozenset({"time.sleep", "asyncio.sleep", "threading.Timer"})
MOST_READ = 5  # places reported at most


def time_reckoning(content: bytes) -> Places:
    """Return `line`, `code` and `fault` (`ticks`, `restart`, `nanosec`, `sec`) of each such place.

    A file that is not Python has none.
    Counted ticks are reported only if the file reads no clock: a counter may well serve something else.
    """
    return places_in(content, _reckoned)


def _reckoned(tree: ast.Module) -> Places:
    names = {node.attr for node in nodes_of(tree, ast.Attribute)}
    found = [place for node in walk(tree) if (place := _part(node, names))]
    found += [place for function in _functions(tree) for place in _restarted(function)]
    if not names & CLOCKS:
        found += [place for function in _functions(tree) for place in _counted(function)]
    return sorted(found, key=lambda place: place["line"])[:MOST_RECKONED]


def _functions(tree: ast.AST) -> list[ast.FunctionDef]:
    return [node for node in nodes_of(tree, ast.FunctionDef) if node.name != "__init__"]


def _counted(function: ast.FunctionDef) -> list[dict[str, Any]]:
    """Return where a function adds a constant to a variable that outlives it, outside of loops."""
    looped = {id(inner) for node in nodes_of(function, ast.For, ast.While) for inner in walk(node)}
    kept = {name for node in nodes_of(function, ast.Global, ast.Nonlocal) for name in node.names}
    return [
        _place(node, "ticks")
        for node in walk(function)
        if id(node) not in looped and (target := _adds(node)) is not None
        if isinstance(target, ast.Attribute) or (isinstance(target, ast.Name) and target.id in kept)
    ]


def _restarted(function: ast.FunctionDef) -> list[dict[str, Any]]:
    """Return where a function sets an attribute to a time without a condition and then takes it from that time."""
    found = []
    for node in function.body:
        if not isinstance(node, ast.Assign) or len(node.targets) != 1 or not isinstance(node.targets[0], ast.Attribute):
            continue
        start, now = unparse(node.targets[0]), unparse(node.value)
        if any(
            isinstance(each, ast.BinOp)
            and isinstance(each.op, ast.Sub)
            and (unparse(each.left), unparse(each.right)) == (now, start)
            and each.lineno > node.lineno
            for each in walk(function)
        ):
            found.append(_place(node, "restart"))
    return found


def _adds(node: ast.AST) -> ast.expr | None:
    """Return what `x += 1`, `x -= 1`, `x = x + 1` change by a positive constant; None for other statements."""
    if isinstance(node, ast.AugAssign) and isinstance(node.op, ast.Add | ast.Sub):
        return node.target if isinstance(node.value, ast.Constant | ast.Name | ast.Attribute) else None
    if isinstance(node, ast.Assign) and isinstance(node.value, ast.BinOp) and len(node.targets) == 1:
        same = unparse(node.targets[0]) == unparse(node.value.left)
        if same and isinstance(node.value.op, ast.Add | ast.Sub) and isinstance(node.value.right, ast.Constant):
            return node.targets[0]
    return None


def _part(node: ast.AST, names: set[str]) -> dict[str, Any] | None:
    """Return the place if only one part of a time, its seconds or its nanoseconds, is used in the file."""
    if isinstance(node, ast.Subscript) and unparse(node.value).endswith("seconds_nanoseconds()"):
        index = node.slice.value if isinstance(node.slice, ast.Constant) else None
        return _place(node, "nanosec" if index else "sec") if index in (0, 1) else None
    if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Load):
        if node.attr == "nanosec" and "sec" not in names:
            return _place(node, "nanosec")
        if node.attr == "sec" and "nanosec" not in names:
            return _place(node, "sec")
    return None


def _place(node: Any, fault: str) -> dict[str, Any]:
    return {"line": node.lineno, "code": unparse(node)[:80], "fault": fault}


ASKED |= {"datetime.datetime.now", "datetime.datetime.utcnow", "datetime.datetime.today", "time.localtime"}


ASKED |= {"rclpy.clock.Clock"}  # a clock of one's own returns system time; the node's clock follows /clock


def wall_clock(content: bytes) -> Places:
    """Return `line`, `call` and whether it `waits`, for each such place in a file; nothing if it is not Python."""
    return places_in(content, _read)


def _read(tree: ast.Module) -> Places:
    names = imported(tree)
    found: list[dict[str, Any]] = []
    for node in nodes_of(tree, ast.Call):
        if (call := dotted(node.func, names)) in ASKED | WAITED:
            ros = call == "rclpy.clock.Clock" and any("ROS_TIME" in unparse(each) for each in _arguments(node))
            if not ros:
                found.append({"line": node.lineno, "call": f"{unparse(node.func)}()", "waits": call in WAITED})
    return sorted(found, key=lambda place: place["line"])[:MOST_READ]


def imported(tree: ast.Module) -> dict[str, str]:
    """Return the full name of each imported name: `from time import monotonic as now` gives now: time.monotonic."""
    names: dict[str, str] = {}
    for node in walk(tree):
        if isinstance(node, ast.Import):
            names |= {alias.asname or alias.name.partition(".")[0]: alias.name for alias in node.names if alias.asname}
            names |= {alias.name.partition(".")[0]: alias.name.partition(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            names |= {alias.asname or alias.name: f"{node.module}.{alias.name}" for alias in node.names}
    return names


def dotted(node: ast.expr, names: dict[str, str]) -> str:
    """Return the full name of what is called; empty if it is not an imported name."""
    if isinstance(node, ast.Attribute):
        owner = dotted(node.value, names)
        return f"{owner}.{node.attr}" if owner else ""
    return names.get(node.id, "") if isinstance(node, ast.Name) else ""


def _arguments(node: ast.Call) -> list[ast.expr]:
    return [*node.args, *(keyword.value for keyword in node.keywords)]
