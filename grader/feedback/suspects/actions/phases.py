"""Suspects in the phases of a drive: one in which the robot turns, and to which nothing leads back."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Words, assigned, functions, nodes_of, unparse
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About


def _turns(block: list[ast.stmt]) -> bool:
    return any(
        unparse(target).endswith("angular.z") and unparse(value) not in ("0", "0.0")
        for part in block
        for target, value in assigned(part)
    )


def _phases(tree: ast.AST) -> Iterator[tuple[str, object]]:
    """Yield the name of a phase, and its value in which alone the robot turns."""
    for node in nodes_of(tree, ast.If):
        name = ""
        value: object = None
        match node.test:
            case ast.Compare(left=left, ops=[ast.Eq()], comparators=[ast.Constant() as constant]):
                name, value = unparse(left), constant.value
            case ast.UnaryOp(ast.Not(), ast.Name() | ast.Attribute() as left):
                name, value = unparse(left), False
            case ast.Name() | ast.Attribute() as left if not _turns(node.body) and _turns(node.orelse):
                yield unparse(left), False
        if name and _turns(node.body) and not _turns(node.orelse):
            yield name, value


@suspicion_of(About.PHASE)
def phases_that_stay_over(tree: ast.AST) -> Words:
    """Find a phase of turning that begins once, before the loop, and that the loop only leaves."""
    for name, value in _phases(tree):
        begins: list[tuple[ast.Assign, bool]] = []
        ends: list[tuple[ast.Assign, bool]] = []
        for function in functions(tree):
            straight = {id(statement) for statement in function.body}
            for statement in nodes_of(function, ast.Assign):
                for target, given in assigned(statement):
                    if unparse(target) != name:
                        continue
                    same = isinstance(given, ast.Constant) and given.value == value
                    (begins if same else ends).append((statement, id(statement) in straight))
        if begins and len(ends) == 1 and all(straight for _, straight in begins):
            (end, _), before = ends[0], begins[-1][0]
            if isinstance(end.value, ast.Constant):
                yield (
                    end,
                    f"{unparse(end)} ends the turning for good: nothing sets it back to "
                    f"{unparse(before.value)} for the next waypoint",
                )
                return
