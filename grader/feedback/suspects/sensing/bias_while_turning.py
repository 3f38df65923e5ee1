"""Suspects in when the bias of a gyroscope is measured: also in the messages in which the robot turns."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Words, last_name, nodes_of, unparse
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About
from gz_course.grader.feedback.suspects.sensing.gyroscopes import angle_sums, assigned_once, expanded, reads_rates

Guards = frozenset[tuple[str, bool]]  # conditions under which a statement is reached, and whether they hold
ADDS = frozenset({"append", "appendleft"})
LEAVES = (ast.Return, ast.Continue, ast.Break, ast.Raise)


@suspicion_of(About.GYROSCOPE)
def collected_in_the_turn(tree: ast.AST) -> Words:
    """Find rates that go into the bias in every call in which the heading grows."""
    for function in reads_rates(tree):
        values, reached = assigned_once(function), dict(_reached(function.body, frozenset()))
        for node, _, _, whole in angle_sums(function):
            live = [each for each, guards in reached.items() if guards <= reached.get(node, frozenset())]
            for statement in live:
                if statement is not node and _kept(statement, values) & _subtracted(whole, live, values):
                    yield (
                        statement,
                        f"{unparse(statement)[:70]} is done while the robot turns, too, so the turn itself is "
                        "subtracted as if it were bias: collect the rates only in the first second, while it stands",
                    )


def _reached(body: list[ast.stmt], guards: Guards) -> Iterator[tuple[ast.stmt, Guards]]:
    """Yield the statements of a block, and of the blocks in it, with the conditions under which each is reached."""
    for statement in body:
        yield statement, guards
        if isinstance(statement, ast.If):
            test = unparse(statement.test)
            yield from _reached(statement.body, guards | {(test, True)})
            yield from _reached(statement.orelse, guards | {(test, False)})
            for branch, holds in ((statement.body, False), (statement.orelse, True)):
                if branch and isinstance(branch[-1], LEAVES):
                    guards |= {(test, holds)}
        elif isinstance(statement, ast.With | ast.Try):
            yield from _reached(statement.body, guards)


def _kept(statement: ast.stmt, values: dict[str, ast.expr]) -> set[str]:
    """Return the attributes into which a statement puts a rate."""
    match statement:
        case ast.Assign(targets=[ast.Attribute() as target], value=value):
            pass
        case ast.AugAssign(target=ast.Attribute() as target, value=value):
            pass
        case ast.Expr(value=ast.Call(func=ast.Attribute(value=ast.Attribute() as target), args=[value]) as call):
            if last_name(call.func) not in ADDS:
                return set()
        case _:
            return set()
    return {unparse(target)} if "angular_velocity" in unparse(expanded(value, values)) else set()


def _subtracted(whole: ast.expr, live: list[ast.stmt], values: dict[str, ast.expr]) -> set[str]:
    """Return the attributes that what is subtracted from a rate is made of, in the statements of the same call."""
    found = {
        name
        for node in nodes_of(whole, ast.BinOp)
        if isinstance(node.op, ast.Sub) and "angular_velocity" in unparse(node.left)
        for name in _attributes(node.right)
    }
    for statement in live:
        if isinstance(statement, ast.Assign) and {unparse(each) for each in statement.targets} & found:
            found |= _attributes(expanded(statement.value, values))
    return found


def _attributes(node: ast.AST) -> set[str]:
    return {unparse(each) for each in nodes_of(node, ast.Attribute)}
