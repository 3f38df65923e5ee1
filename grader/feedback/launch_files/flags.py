"""Expressions of a launch file that add `-r` to the command of the simulator in the wrong case."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import walk
from gz_course.grader.feedback.launch_files import launch_slip
from gz_course.grader.feedback.launch_files.reading import LaunchFile, Place, text

PAUSED = "paused"
TRUE = re.compile(r"^\s*(['\"])(.*?)\1\s+if\b(.*?)\belse\s*(['\"])(.*?)\4\s*$")
HOLDS = re.compile(
    rf"\b{PAUSED}\b\W*(?:\)|\])?\W*(?:\.lower\(\))?\W*==\W*true\b|\btrue\b\W*==\W*{PAUSED}\b", re.IGNORECASE
)


@launch_slip
def runs_when_paused(file: LaunchFile) -> Iterator[Place]:
    """Find `-r`, which lets the world run, where the argument paused is true."""
    for call in file.calls("PythonExpression"):
        parts = file.value(call.args[0]) if call.args else None
        elements = parts.elts if isinstance(parts, ast.List | ast.Tuple) else [parts] if parts else []
        words = "".join(text(each) or file.configuration(each) for each in elements)
        if (match := TRUE.match(words)) and _exchanged(match[2], match[5]) and HOLDS.search(match[3]):
            yield call.lineno, _words(match[2])
    for node in file.nodes:
        if not isinstance(node, ast.IfExp) or not _asks_for_paused(file, node.test):
            continue
        first, second = ([text(each) for each in walk(part)] for part in (node.body, node.orelse))
        if _exchanged(" ".join(first), " ".join(second)):
            yield node.lineno, _words("-r")


def _exchanged(when_true: str, otherwise: str) -> bool:
    return "-r" in when_true.split() and "-r" not in otherwise.split()


def _asks_for_paused(file: LaunchFile, test: ast.expr) -> bool:
    """Return whether a condition is that the text of the argument paused is 'true'."""
    if not isinstance(test, ast.Compare) or len(test.ops) != 1 or not isinstance(test.ops[0], ast.Eq):
        return False
    sides = [test.left, test.comparators[0]]
    names = [file.performed(_without_lower(each)) for each in sides]
    return PAUSED in names and any(text(each).lower() == "true" for each in sides)


def _without_lower(node: ast.expr) -> ast.expr:
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in ("lower", "strip"):
        return node.func.value
    return node


def _words(flag: str) -> str:
    return (
        f"this gives '{flag.strip()}' where paused is true, and -r lets the world run: the two cases of the "
        "expression are exchanged"
    )
