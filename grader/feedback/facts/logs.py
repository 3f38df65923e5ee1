"""Lines of a log that nobody gets, and lines that are logged seldom.

Exercises that ask for a log use them: elsewhere such lines do no harm.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Place, Places, last_name, nodes_of, places_in, unparse, walk
from gz_course.grader.feedback.slips.language.sequences import LEVELS

# Options of the methods of a logger.
# Source: `_supported_filters` in rclpy/impl/rcutils_logger.py of rclpy 7.1
FILTERS = {
    "throttle_duration_sec": "lets this line through once in {value} s only",
    "once": "lets this line through once only",
    "skip_first": "leaves out the first line",
}


def seldom_log(content: bytes) -> Places:
    """Return where an option of a logger leaves lines out, and `said`, the words of a sentence."""
    return places_in(content, lambda tree: [{"line": line, "said": said} for line, said in _seldom(tree)])


def _seldom(tree: ast.Module) -> Iterator[Place]:
    for node in nodes_of(tree, ast.Call):
        if isinstance(node.func, ast.Attribute) and node.func.attr in LEVELS:
            for option in node.keywords:
                if option.arg in FILTERS and unparse(option.value) not in ("False", "0", "0.0", "None"):
                    value = unparse(option.value)
                    yield option.lineno, f"{option.arg}={value} {FILTERS[option.arg].format(value=value)}"


def silent_log(content: bytes) -> Places:
    """Return where a file logs what nobody gets, and `said`, the words of a sentence; nothing if a line arrives."""
    return places_in(content, lambda tree: [{"line": line, "said": said} for line, said in _silent(tree)][:1])


def _silent(tree: ast.Module) -> Iterator[Place]:
    calls = [
        node for node in nodes_of(tree, ast.Call) if isinstance(node.func, ast.Attribute) and node.func.attr in LEVELS
    ]
    names = {node.attr for node in nodes_of(tree, ast.Attribute)}
    imported = any(
        isinstance(node, ast.Import) and any(each.name == "logging" for each in node.names) for node in walk(tree)
    )
    for call in sorted(calls, key=lambda each: each.lineno):
        if imported and "get_logger" not in names:
            yield (
                call.lineno,
                "the module logging is Python's own log, which ROS does not read; the log of the node is "
                "self.get_logger().info(...)",
            )
        elif "get_logger" in names and {last_name(each.func) for each in calls} == {"debug"}:
            yield call.lineno, "debug() is silent at a logger's usual level, INFO: use info()"
