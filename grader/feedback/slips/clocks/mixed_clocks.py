"""A difference between the computer's time and a stamp of simulated time."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Place, nodes_of, unparse, walk
from gz_course.grader.feedback.facts.wall_clock import ASKED, dotted, imported
from gz_course.grader.feedback.slips import slip

OF_STAMPS = re.compile(r"\bheader\.stamp\b|\.nanosec\b|get_clock\(\)\.now\(\)")
STEPS = 4  # names followed at most


@slip
def mixed(tree: ast.Module) -> Iterator[Place]:
    """Find `time.time() - stamp` and comparisons of the two, also by way of names."""
    names = imported(tree)
    values = _values(tree)
    if not any(_wall(node, {}, names, 0) for node in tree.body):
        return
    for node in walk(tree):
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Sub):
            sides = node.left, node.right
        elif isinstance(node, ast.Compare) and len(node.ops) == 1:
            sides = node.left, node.comparators[0]
        else:
            continue
        for one, other in (sides, sides[::-1]):
            wall, stamps = _wall(one, values, names, STEPS), _wall(other, values, names, STEPS)
            if wall and not stamps and _of_stamps(other, values, STEPS) and not _of_stamps(one, values, STEPS):
                yield (
                    node.lineno,
                    f"{unparse(node)[:70]}: {wall}() is the time of the computer, and the other side is simulated "
                    "time, which begins at 0: their difference is no age; self.get_clock().now() is the node's time",
                )
                break


def _values(tree: ast.AST) -> dict[str, list[ast.expr]]:
    found: dict[str, list[ast.expr]] = {}
    for node in nodes_of(tree, ast.Assign):
        if len(node.targets) == 1:
            found.setdefault(unparse(node.targets[0]), []).append(node.value)
    return found


def _known(node: ast.AST, values: dict[str, list[ast.expr]]) -> Iterator[ast.expr]:
    """Yield what is assigned to the names in an expression."""
    for each in nodes_of(node, ast.Name, ast.Attribute):
        yield from values.get(unparse(each), [])


def _wall(node: ast.AST, values: dict[str, list[ast.expr]], names: dict[str, str], steps: int) -> str:
    """Return the call that reads the computer's clock in an expression; empty if none does."""
    for each in nodes_of(node, ast.Call):
        if dotted(each.func, names) in ASKED - {"rclpy.clock.Clock"}:
            return unparse(each.func)
    found = (_wall(each, values, names, steps - 1) for each in _known(node, values)) if steps else iter(())
    return next(filter(None, found), "")


def _of_stamps(node: ast.AST, values: dict[str, list[ast.expr]], steps: int) -> bool:
    if OF_STAMPS.search(unparse(node)):
        return True
    return steps > 0 and any(_of_stamps(each, values, steps - 1) for each in _known(node, values))
