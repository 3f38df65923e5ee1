"""The places where a Python file reads the wall clock or waits by it instead of by simulated time.

Kinds of submissions that are Python record these places as facts of a run. The diagnosis mentions them only if a check
saw the right thing at the wrong time (`grader/score/clocks.py`), because a node may well measure its own speed.
"""

from __future__ import annotations

import ast
from typing import Any

from gz_course.grader.feedback.facts.syntax import Places, nodes_of, places_in, unparse, walk

ASKED = frozenset(
    f"time.{name}{unit}" for name in ("time", "monotonic", "perf_counter", "process_time") for unit in ("", "_ns")
)
ASKED |= {"datetime.datetime.now", "datetime.datetime.utcnow", "datetime.datetime.today", "time.localtime"}
ASKED |= {"rclpy.clock.Clock"}  # a clock of one's own returns system time; the node's clock follows /clock
WAITED = frozenset({"time.sleep", "asyncio.sleep", "threading.Timer"})
MOST = 5  # places reported at most


def wall_clock(content: bytes) -> Places:
    """Return `line`, `call` and whether it `waits`, for each such place in a file; nothing if it is not Python."""
    return places_in(content, _places)


def _places(tree: ast.Module) -> Places:
    names = imported(tree)
    found: list[dict[str, Any]] = []
    for node in nodes_of(tree, ast.Call):
        if (call := dotted(node.func, names)) in ASKED | WAITED:
            ros = call == "rclpy.clock.Clock" and any("ROS_TIME" in unparse(each) for each in _arguments(node))
            if not ros:
                found.append({"line": node.lineno, "call": f"{unparse(node.func)}()", "waits": call in WAITED})
    return sorted(found, key=lambda place: place["line"])[:MOST]


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
