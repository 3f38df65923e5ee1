"""Whole seconds and the nanoseconds within one, put together with a wrong factor, or one taken for the whole time."""

from __future__ import annotations

import ast
import math
from collections.abc import Iterator, Mapping

from gz_course.grader.feedback.facts.constants import Number, named_numbers, number
from gz_course.grader.feedback.facts.syntax import Place, Words, last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.slips import slip, slip_of

BEFORE = ("no_effect", "publishers")


@slip_of(ast.Compare)
def parts_of_a_second(node: ast.Compare, tree: ast.AST) -> Words:
    """Find the nanoseconds within a second compared with a whole second or more, which they never reach."""
    numbers = named_numbers(tree)
    if len(node.ops) != 1:
        return
    limit = number(node.comparators[0], numbers)
    within = last_name(node.left) == "nanosec" or unparse(node.left).endswith("seconds_nanoseconds()[1]")
    if within and limit is not None and limit >= 1e9:
        yield (
            f"{unparse(node)[:70]}: these are the nanoseconds within the current second, always less than "
            "1e9: the whole time is sec + nanosec / 1e9, or Time.nanoseconds"
        )


@slip
def sums_of_parts(tree: ast.AST) -> Iterator[Place]:
    """Find a sum of seconds and nanoseconds in which the second part has another unit than the first."""
    numbers, names = named_numbers(tree), _names_of_parts(tree)
    for node in nodes_of(tree, ast.BinOp):
        if not isinstance(node.op, ast.Add):
            continue
        for one, other in ((node.left, node.right), (node.right, node.left)):
            whole, part = _factor(one, "sec", names, numbers), _factor(other, "nanosec", names, numbers)
            if whole and part and not math.isclose(part / whole, 1e-9, rel_tol=1e-6):
                yield (
                    node.lineno,
                    f"{unparse(node)[:80]}: a nanosecond is 1e-9 s, and here it counts as {part / whole:g} s: "
                    "sec + nanosec * 1e-9 are seconds; Time.from_msg(stamp) takes both",
                )
                return


def _names_of_parts(tree: ast.AST) -> dict[str, str]:
    """Return which part of a time a name holds, for those that take the two of `seconds_nanoseconds()`."""
    names: dict[str, str] = {}
    for node in walk(tree):
        match node:
            case ast.Assign(
                targets=[ast.Tuple(elts=[one, other])],
                value=ast.Call(func=ast.Attribute(attr="seconds_nanoseconds")),
            ):
                names |= {unparse(one): "sec", unparse(other): "nanosec"}
    return names


def _factor(node: ast.expr, part: str, names: Mapping[str, str], numbers: Mapping[str, Number]) -> float | None:
    """Return the number by which a part of a time is multiplied; None if an expression is not that part alone."""
    match node:
        case ast.Attribute() | ast.Name():
            return 1.0 if names.get(unparse(node), last_name(node)) == part else None
        case ast.Call(func=ast.Name(id="int" | "float" | "round"), args=[inner]):
            return _factor(inner, part, names, numbers)
        case ast.BinOp(left=left, op=ast.Mult(), right=right):
            for one, other in ((left, right), (right, left)):
                inner_factor, factor = _factor(one, part, names, numbers), number(other, numbers)
                if inner_factor and factor:
                    return inner_factor * factor
        case ast.BinOp(left=left, op=ast.Div() | ast.FloorDiv(), right=right):
            inner_factor, factor = _factor(left, part, names, numbers), number(right, numbers)
            return inner_factor / factor if inner_factor and factor else None
    return None


@slip
def nanoseconds_alone(tree: ast.AST) -> Iterator[Place]:
    """Find the nanoseconds of a stamp used as its time, in a file that reads the seconds nowhere."""
    names = {last_name(node) for node in nodes_of(tree, ast.Attribute)}
    if names & {"sec", "seconds_nanoseconds"}:
        return
    copied = {id(node.value) for node in nodes_of(tree, ast.Assign) if last_name(node.targets[0]) == "nanosec"}
    for node in walk(tree):
        read = isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Load) and node.attr == "nanosec"
        if read and id(node) not in copied:
            yield (
                node.lineno,  # type: ignore[attr-defined]
                f"{unparse(node)[:70]} is the part of the time within a second, which begins at 0 again each "
                "second, and sec is read nowhere: Time.from_msg(stamp).nanoseconds is the whole time",
            )
            return
