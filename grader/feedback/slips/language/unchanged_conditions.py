"""A loop whose condition is of numbers that nothing in the loop changes."""

from __future__ import annotations

import ast

from gz_course.grader.feedback.facts.syntax import Words, nodes_of, unparse, walk
from gz_course.grader.feedback.slips import slip_of


def _numbers(test: ast.expr) -> set[str]:
    """Return the names in a comparison of names and numbers; nothing if it holds anything else."""
    if not isinstance(test, ast.Compare) or isinstance(test.ops[0], ast.Is | ast.IsNot | ast.In | ast.NotIn):
        return set()
    sides = [test.left, *test.comparators]
    names = {each.id for each in sides if isinstance(each, ast.Name)}
    numbers = [each for each in sides if isinstance(each, ast.Constant) and isinstance(each.value, int | float)]
    return names if numbers and len(names) + len(numbers) == len(sides) else set()


def _leaves(loop: ast.While) -> bool:
    """Return whether a loop is left in another way than by a cancellation."""
    asked = [each for each in nodes_of(loop, ast.If) if "cancel" in unparse(each.test)]
    cancelled = {id(node) for each in asked for part in each.body for node in walk(part)}
    ways = (ast.Break, ast.Return, ast.Raise, ast.Yield, ast.Await)
    return any(isinstance(each, ways) and id(each) not in cancelled for each in walk(loop))


@slip_of(ast.FunctionDef)
def never_changes(function: ast.FunctionDef) -> Words:
    """Find `while left > 0.1:` where left was computed above the loop, and nowhere in it."""
    shared = {n for each in nodes_of(function, ast.Global, ast.Nonlocal) for n in each.names}
    stores = [n for n in nodes_of(function, ast.Name) if isinstance(n.ctx, ast.Store)]
    for loop in nodes_of(function, ast.While):
        names = _numbers(loop.test)
        inside = {id(node) for node in walk(loop)}
        above = [n for n in stores if n.id in names and n.lineno < loop.lineno and id(n) not in inside]
        changed = {n.id for n in stores if id(n) in inside} | shared
        if names and not names & changed and {n.id for n in above} == names and not _leaves(loop):
            last = max(above, key=lambda node: node.lineno)
            yield (
                loop,
                f"nothing in this loop changes {last.id}, which line {last.lineno} has computed, so "
                f"`{unparse(loop.test)[:60]}` stays as it is: compute it again in every iteration",
            )
