"""Colours that were divided by 255, so that they are between 0 and 1, and are compared with a number of 8 bits."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.constants import named_numbers, number
from gz_course.grader.feedback.facts.syntax import Place, assigned, called, last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.slips import slip
from gz_course.grader.feedback.slips.language.own_calls import calls_of_own, parameters

WHOLE = (255, 256)
SAME = frozenset({"astype", "copy", "squeeze", "transpose", "split", "moveaxis", "dsplit", "asarray", "array"})
STEPS = 4  # assignments and calls that hand a picture on, at most


@slip
def shares_as_bytes(tree: ast.AST) -> Iterator[Place]:
    """Find comparisons such as `red > 50` that no share of 255 ever fulfils."""
    names = _shares(tree) if called(tree) & {"imgmsg_to_cv2", "frombuffer"} else set()
    known = named_numbers(tree) if names else {}
    for node in walk(tree) if names else ():
        if not isinstance(node, ast.Compare) or len(node.ops) != 1:
            continue
        left, right = node.left, node.comparators[0]
        if isinstance(node.ops[0], ast.Lt | ast.LtE):
            left, right = right, left
        elif not isinstance(node.ops[0], ast.Gt | ast.GtE):
            continue
        limit = number(right, known)
        if limit is not None and limit > 1 and _is_share(left, names):
            yield (
                node.lineno,
                f"{unparse(node)[:60]} never holds: {unparse(left)[:40]} was divided by 255, so it is between 0 and 1",
            )


def _shares(tree: ast.AST) -> set[str]:
    """Return the names that hold nothing but colours that were divided by 255."""
    given: dict[str, list[ast.expr]] = {}
    for target, value in assigned(tree):
        for each in target.elts if isinstance(target, ast.Tuple) else [target]:
            given.setdefault(unparse(each), []).append(value)
    for function, made in calls_of_own(tree):
        for call in made:
            for name, value in zip(parameters(function), call.args, strict=False):
                if unparse(value) != name:
                    given.setdefault(name, []).append(value)
    loops = [unparse(node.target) for node in nodes_of(tree, ast.For, ast.comprehension)]
    names: set[str] = set()
    for _ in range(STEPS):
        names |= {name for name, values in given.items() if all(_is_share(each, names) for each in values)}
    return names - set(loops)


def _is_share(node: ast.expr, names: set[str]) -> bool:
    match node:
        case ast.BinOp(op=ast.Div(), right=ast.Constant(value=whole)):
            return whole in WHOLE
        case ast.Name() | ast.Attribute():
            return unparse(node) in names
        case ast.Subscript(value=value):
            return _is_share(value, names)
        case ast.Call(func=ast.Attribute(value=owner) as method) if last_name(method) in SAME:
            return any(_is_share(each, names) for each in (owner, *node.args[:1]))
    return False
