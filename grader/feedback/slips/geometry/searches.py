"""Searches for the smallest or largest value that begin wrongly, and loops over numbers of rays."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Words, assigned, calls, nodes_of, unparse, walk
from gz_course.grader.feedback.slips import slip_of

LARGE = 50.0  # more than what a lidar of a small robot measures [m]
LIMITS = frozenset({"range_min", "range_max"})


@slip_of(ast.If)
def relaxed_upwards(node: ast.If) -> Words:
    """Find `if new > cost[cell]: cost[cell] = new` in a search that goes on from the cell."""
    match node.test:
        case ast.Compare(left=new, ops=[ast.Gt() | ast.GtE()], comparators=[known]):
            pass
        case ast.Compare(left=known, ops=[ast.Lt() | ast.LtE()], comparators=[new]):
            pass
        case _:
            return
    of = known.func.value if isinstance(known, ast.Call) and isinstance(known.func, ast.Attribute) else None
    of = known.value if isinstance(known, ast.Subscript) else of
    stored = any(
        isinstance(target, ast.Subscript)
        and of is not None
        and unparse(target.value) == unparse(of)
        and unparse(value) == unparse(new)
        for target, value in assigned(node)
    )
    if stored and any(name in ("heappush", "put", "append") for _, name in calls(node)):
        yield (
            f"`{unparse(node.test)[:60]}` takes a way that is longer than the one that is known, so the costs "
            "grow without end and the search goes on for ever: a way is better if its cost is less, <"
        )


def _searched(loop: ast.For) -> Iterator[tuple[str, bool]]:
    """Yield each name that a loop sets to the value it is compared with, and whether to the smaller one."""
    for node in walk(loop):
        if isinstance(node, ast.If):
            for each in nodes_of(node.test, ast.Compare):
                sides = [each.left, *each.comparators]
                for left, operator, right in zip(sides, each.ops, each.comparators, strict=False):
                    less = isinstance(operator, ast.Lt | ast.LtE)
                    if not less and not isinstance(operator, ast.Gt | ast.GtE):
                        continue
                    for name, other, smaller in ((right, left, less), (left, right, not less)):
                        if isinstance(name, ast.Name) and _sets(node, name.id, other):
                            yield name.id, smaller
        elif isinstance(node, ast.Assign) and isinstance(node.value, ast.Call) and len(node.value.args) == 2:
            called = unparse(node.value.func)
            names = [unparse(each) for each in node.value.args]
            if called in ("min", "max") and unparse(node.targets[0]) in names:
                yield unparse(node.targets[0]), called == "min"


def _sets(node: ast.If, name: str, value: ast.expr) -> bool:
    return any(
        isinstance(each, ast.Assign) and unparse(each.targets[0]) == name and unparse(each.value) == unparse(value)
        for each in node.body
    )


@slip_of(ast.FunctionDef)
def begins_at_an_end(function: ast.FunctionDef) -> Words:
    """Find a search for the smallest value that begins at 0, or for the largest that begins at a large number."""
    if ".ranges" not in unparse(function):
        return  # what is searched may be no distance
    first: dict[str, tuple[int, float]] = {}
    for node in nodes_of(function, ast.Assign):
        if len(node.targets) == 1 and isinstance(node.targets[0], ast.Name):
            name = node.targets[0].id
            value = node.value.value if isinstance(node.value, ast.Constant) else None
            if name not in first and type(value) in (int, float):
                first[name] = node.lineno, float(value)  # type: ignore[arg-type]
    for loop in nodes_of(function, ast.For):
        for name, smallest in _searched(loop):
            line, value = first.get(name, (0, float("nan")))
            if smallest and line and line < loop.lineno and value <= 0:
                yield (
                    line,
                    f"{name} begins at {value:g}, and no distance is smaller: it stays {value:g}. A search for the "
                    "smallest begins at math.inf, or use min(...)",
                )
            elif not smallest and line and line < loop.lineno and value >= LARGE:
                yield (
                    line,
                    f"{name} begins at {value:g}, and no distance is larger: it stays {value:g}. A search for the "
                    "largest begins at 0, or use max(...)",
                )


def _number(loop: ast.For | ast.comprehension) -> str:
    """Return the name that counts in a loop over range(len(...)) or enumerate(...); empty if none does."""
    if not isinstance(loop.iter, ast.Call):
        return ""
    called = unparse(loop.iter.func)
    if called == "range" and isinstance(loop.target, ast.Name) and "len(" in unparse(loop.iter):
        return loop.target.id
    if called == "enumerate" and isinstance(loop.target, ast.Tuple) and isinstance(loop.target.elts[0], ast.Name):
        return loop.target.elts[0].id
    return ""


@slip_of(ast.For, ast.comprehension, first=True)
def numbers_for_ranges(loop: ast.For | ast.comprehension, tree: ast.AST) -> Words:
    """Find the number of a ray that is compared with range_min or range_max."""
    name = _number(loop)
    within = loop if isinstance(loop, ast.For) else tree
    tests = [each for each in nodes_of(within, ast.Compare)] if name else []
    if isinstance(loop, ast.comprehension):
        tests = [each for test in loop.ifs for each in nodes_of(test, ast.Compare)]
    for test in tests:
        sides = [test.left, *test.comparators]
        limits = any(isinstance(side, ast.Attribute) and side.attr in LIMITS for side in sides)
        if limits and any(isinstance(side, ast.Name) and side.id == name for side in sides):
            yield (
                test,
                f"{name} is the number of a ray, 0, 1, 2 ..., and is compared with a distance: the range of that "
                f"ray is ranges[{name}]",
            )
