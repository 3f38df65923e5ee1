"""What is computed and then lost: set back before it is published or logged, or by the else of a search."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Place, Words, assigned, calls, nodes_of, unparse, walk
from gz_course.grader.feedback.slips import slip, slip_of

SENT = frozenset({"publish", "info"})


@slip
def search_of_another(tree: ast.AST) -> Iterator[Place]:
    """Find `if r < valid[0]: nearest = r` in a loop over valid, which compares with the first value, not the best."""
    for loop in (node for node in nodes_of(tree, ast.For) if isinstance(node.target, ast.Name)):
        first = f"{unparse(loop.iter)}[0]"
        for node in nodes_of(loop, ast.If):
            if not isinstance(node.test, ast.Compare):
                continue
            sides = {unparse(each) for each in (node.test.left, *node.test.comparators)}
            for target, value in (pair for each in node.body for pair in assigned(each)):
                if sides == {unparse(loop.target), first} and unparse(value) == unparse(loop.target):
                    yield (
                        node.lineno,
                        f"{unparse(node.test)} compares with the first value each time, so {unparse(target)} "
                        "becomes the last value that is better than the first; compare with the best so far",
                    )


def _constant(value: ast.expr) -> bool:
    """Return whether a value is a number, or infinity under one of its names."""
    if isinstance(value, ast.Constant) and isinstance(value.value, int | float):
        return True
    return unparse(value) in ("math.inf", "inf", "float('inf')", "np.inf", "numpy.inf", "-math.inf")


def _computes(statement: ast.stmt, name: str) -> bool:
    return any(unparse(target) == name and not _constant(value) for target, value in assigned(statement))


def _sends(statement: ast.stmt, name: str) -> int:
    """Return the line in which a statement by itself publishes or logs a name; 0 if it does not."""
    if not isinstance(statement, ast.Expr):
        return 0
    for call, what in calls(statement):
        if what in SENT and any(unparse(each) == name for given in _given(call) for each in walk(given)):
            return call.lineno
    return 0


def _given(call: ast.Call) -> list[ast.expr]:
    return [*call.args, *(each.value for each in call.keywords)]


@slip_of(ast.FunctionDef, first=True)
def before_it_is_sent(function: ast.FunctionDef) -> Words:
    """Find `self.nearest = math.inf` in every call, between the loop that finds it and the publish() of it."""
    for i, statement in enumerate(function.body):
        if not isinstance(statement, ast.Assign) or len(statement.targets) != 1 or not _constant(statement.value):
            continue
        name = unparse(statement.targets[0])
        if not any(_computes(each, name) for each in function.body[:i]):
            continue
        for later in function.body[i + 1 :]:
            if any(unparse(target) == name for target, _ in assigned(later)):
                break
            if line := _sends(later, name):
                yield (
                    statement,
                    f"{unparse(statement)[:60]} comes before line {line}, which sends {name}: what was found "
                    "is lost; set it back after that line, or at the beginning of the function",
                )


@slip_of(ast.For)
def else_of_a_search(loop: ast.For) -> Words:
    """Find `if r < best: best = r` in a loop whose else sets best to something that is not in the scan's own loop."""
    values = {node.id for node in nodes_of(loop.target, ast.Name)}
    for node in (each for each in nodes_of(loop, ast.If) if isinstance(each.test, ast.Compare)):
        sides = {unparse(each) for each in (node.test.left, *node.test.comparators)}  # type: ignore[attr-defined]
        kept = {
            unparse(target)
            for each in node.body
            for target, value in assigned(each)
            if {unparse(target), unparse(value)} == sides and unparse(value) in values
        }
        for each in node.orelse:
            for target, value in assigned(each) if isinstance(each, ast.Assign) else ():
                if unparse(target) in kept and not values & {unparse(part) for part in walk(value)}:
                    yield (
                        each,
                        f"{unparse(each)[:60]} forgets what was found as soon as one value is no better: only "
                        "the last ones count; a search needs no else",
                    )
