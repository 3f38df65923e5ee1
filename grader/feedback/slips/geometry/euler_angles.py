"""Euler angles of a quaternion in another order than the function takes or gives them."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import (
    Place,
    Words,
    assigned,
    functions,
    last_name,
    nodes_of,
    unparse,
)
from gz_course.grader.feedback.slips import slip, slip_of

MAKES = "euler_from_quaternion"
HEADING = re.compile(r"yaw|heading|theta|\bth\b")
ORDER = ("roll", "pitch", "yaw")


def _is_euler(node: ast.AST) -> bool:
    return isinstance(node, ast.Call) and last_name(node.func) == MAKES


@slip
def other_angle(tree: ast.AST) -> Iterator[Place]:
    """Find `yaw, pitch, roll = euler_from_quaternion(q)`, and its first element taken for the heading."""
    if MAKES in {function.name for function in functions(tree)}:
        return  # one of the student's own may return them in any order
    names = {unparse(target) for target, value in assigned(tree) if _is_euler(value)}
    for node in nodes_of(tree, ast.Assign):
        target, value = node.targets[0], node.value
        if isinstance(target, ast.Tuple | ast.List) and len(target.elts) == len(ORDER):
            if _is_euler(value) or unparse(value) in names:
                for place, each in enumerate(target.elts[:2]):
                    if HEADING.search(unparse(each).lower()):
                        yield node.lineno, _said(unparse(each), place)
        elif isinstance(value, ast.Subscript) and (_is_euler(value.value) or unparse(value.value) in names):
            index = value.slice.value if isinstance(value.slice, ast.Constant) else None
            if isinstance(index, int) and index in (0, 1) and HEADING.search(unparse(target).lower()):
                yield node.lineno, _said(unparse(target), index)


def _said(name: str, place: int) -> str:
    return (
        f"{name} gets the {ORDER[place]}, which is nearly 0 on flat ground: {MAKES}() returns roll, pitch and yaw, in "
        "this order"
    )


@slip_of(ast.Call)
def other_order(call: ast.Call) -> Words:
    """Find `euler_from_quaternion([q.w, q.x, q.y, q.z])`: w is the last one."""
    name = last_name(call.func)
    given = call.args[0] if call.args else None
    if name == MAKES and isinstance(given, ast.List | ast.Tuple):
        parts = "".join(last_name(each) for each in given.elts)
        if sorted(parts) == sorted("xyzw") and parts != "xyzw":
            yield f"{MAKES}() takes x, y, z, w in this order, and gets {', '.join(parts)}"
