"""Suspects in the rule by which two points are the same thing: one coordinate, a distance alone, or a wrong limit."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence

from gz_course.grader.feedback.facts.constants import named_numbers, number
from gz_course.grader.feedback.facts.syntax import (
    Words,
    assigned,
    called,
    calls,
    functions,
    last_name,
    nodes_of,
    unparse,
    walk,
)
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About
from gz_course.grader.feedback.suspects.sensing.known_places import kept

ONE_NUMBER = re.compile(r"lambda (\w+): (?:abs\()?\1\[[01]\]\)?|(?:operator\.)?itemgetter\([01]\)")
DISTANCE = re.compile("hypot|dist|norm|sqrt")
MEASURES = {"distance": ("hypot", "norm", "sqrt"), "direction": ("atan2", "arctan2", "atan", "arctan")}
FARTHEST, NEAREST = 1.5, 0.05  # [m] limits beyond which no sensible rule for the same post is
Loop = ast.For | ast.comprehension


@suspicion_of(About.NEAREST)
def smallest_x(tree: ast.AST) -> Words:
    """Find the smallest of known places by their first number, in place of their distance."""
    names = {name for _, _, name in kept(tree)}
    for call, name in calls(tree):
        if name not in ("min", "sorted") or not call.args or unparse(call.args[0]) not in names:
            continue
        key = next((each.value for each in call.keywords if each.arg == "key"), None)
        by = None if key is None else ONE_NUMBER.fullmatch(unparse(key))
        if key is None or by:
            which = "second numbers, y," if by and "1" in by[0][-3:] else "first numbers, x,"
            yield (
                call,
                f"{unparse(call)[:60]} compares the {which} and not distances: give it key=lambda post: hypot(*post)",
            )


@suspicion_of(About.SAME)
def each_coordinate(tree: ast.AST) -> Words:
    """Find points that are the same as soon as one of their coordinates is about the same."""
    if not any(kept(tree)):
        return
    for node in walk(tree):
        far = (
            isinstance(node, ast.BoolOp)
            and isinstance(node.op, ast.And)
            and all(_off(v, far=True) for v in node.values)
        )
        near = (
            isinstance(node, ast.BoolOp)
            and isinstance(node.op, ast.Or)
            and all(_off(v, far=False) for v in node.values)
        )
        if isinstance(node, ast.Call):
            inside = node.func.value if isinstance(node.func, ast.Attribute) and not node.args else None
            inside = node.args[0] if node.args and inside is None else inside
            arrays = isinstance(inside, ast.Compare) and "np." in unparse(node)
            far |= arrays and last_name(node.func) == "all" and _off(inside, far=True)
            near |= arrays and last_name(node.func) == "any" and _off(inside, far=False)
        if far or near:
            yield (
                node,
                f"{unparse(node)[:80]}: so two posts are the same as soon as their x or their y is about the same; "
                "compare the distance between them, hypot(x - a, y - b)",
            )


def _off(node: ast.AST | None, far: bool) -> bool:
    """Say whether a comparison holds for a difference without its sign that is large (`far`), or small."""
    if not isinstance(node, ast.Compare) or len(node.ops) != 1 or DISTANCE.search(unparse(node)):
        return False
    first, second = node.left, node.comparators[0]
    size = (bool(called(first) & {"abs", "fabs"}), bool(called(second) & {"abs", "fabs"}))
    greater = isinstance(node.ops[0], ast.Gt | ast.GtE)
    if size == (True, False):
        return greater == far and isinstance(node.ops[0], ast.Gt | ast.GtE | ast.Lt | ast.LtE)
    return size == (False, True) and greater != far and isinstance(node.ops[0], ast.Gt | ast.GtE | ast.Lt | ast.LtE)


@suspicion_of(About.SAME)
def cancelling_differences(tree: ast.AST) -> Words:
    """Find `abs((x - a) + (y - b))`, in which two differences may cancel each other."""
    for function in {each.name: each for each, _, _ in kept(tree)}.values():
        for call, name in calls(function):
            match call.args:
                case [ast.BinOp(op=ast.Add(), left=ast.BinOp(op=ast.Sub()), right=ast.BinOp(op=ast.Sub()))] if name in (
                    "abs",
                    "fabs",
                ):
                    yield (
                        call,
                        f"{unparse(call)[:60]} is small, too, where the two differences cancel each other, so "
                        "posts at other places are taken for one: compare the distance, hypot(x - a, y - b)",
                    )


def _read(node: ast.AST, loop: Loop) -> Iterator[ast.AST]:
    """Yield all that is done with what a loop goes through."""
    made = getattr(node, "elt", None)
    if made is not None and unparse(made) == unparse(loop.target):
        made = None  # the list holds what is left of the known ones
    parts = node.body if isinstance(node, ast.For) else [made, *getattr(loop, "ifs", [])]
    for part in parts:
        for each in walk(part) if part is not None else ():
            held = isinstance(each, ast.Name) and isinstance(each.ctx, ast.Store)
            if not held and not (isinstance(each, ast.Name) and _indexed(parts, each)):
                yield each


def _indexed(parts: Sequence[ast.AST | None], name: ast.Name) -> bool:
    """Say whether a name stands before an index."""
    return any(
        isinstance(each, ast.Subscript) and each.value is name
        for part in parts
        if part is not None
        for each in walk(part)
    )


def _coordinates(target: ast.expr) -> list[str]:
    if isinstance(target, ast.Tuple) and len(target.elts) == 2:
        return [unparse(each) for each in target.elts]
    return [f"{target.id}[0]", f"{target.id}[1]"] if isinstance(target, ast.Name) else []


@suspicion_of(About.SAME)
def one_coordinate(tree: ast.AST) -> Words:
    """Find known places of which one coordinate only is compared."""
    names = {name for _, _, name in kept(tree)}
    for node in walk(tree):
        loops: list[Loop] = [node] if isinstance(node, ast.For) else [*getattr(node, "generators", [])]
        for loop in loops:
            if unparse(loop.iter) not in names:
                continue
            used = {unparse(each) for each in _read(node, loop) if isinstance(each, ast.Name | ast.Subscript)}
            both = _coordinates(loop.target)
            alone = [each for each in both if each in used]
            compared = [each for each in _read(node, loop) if isinstance(each, ast.Compare)]
            if len(alone) == 1 and unparse(loop.target) not in used and compared:
                yield (
                    compared[0],
                    f"{unparse(compared[0])[:60]} compares one coordinate only, and two posts may have the same: "
                    "compare the distance between them, hypot(x - a, y - b)",
                )


@suspicion_of(About.SAME)
def one_measure(tree: ast.AST) -> Words:
    """Find places whose distances from the robot are compared, or whose directions, and nothing else."""
    for function in {each.name: each for each, _, _ in kept(tree)}.values():
        measures = {name: _measures(function, tree, name) for name in ("distance", "direction")}
        found = [
            (node, name)
            for node in nodes_of(function, ast.BinOp)
            if isinstance(node.op, ast.Sub)
            for name, known in measures.items()
            if _is_measure(node.left, known, name) and _is_measure(node.right, known, name)
        ]
        if len({name for _, name in found}) != 1:
            continue
        node, name = found[0]
        other = "in other directions" if name == "distance" else "farther away"
        if _all_compared(function) == 1:
            yield (
                node,
                f"{unparse(node)[:60]} compares only the {name} of two posts as the robot sees them, so posts "
                f"{other} with about the same {name} are taken for one: compare their places, hypot(x - a, y - b)",
            )


@suspicion_of(About.SAME)
def wrong_limits(tree: ast.AST) -> Words:
    """Find distances between places that are compared with a limit that is far too large, or far too small."""
    known = named_numbers(tree)
    if not any(kept(tree)):
        return
    adding = {function.name for function, _, _ in kept(tree)}
    for function in functions(tree):
        if function.name not in adding:
            continue
        for node in nodes_of(function, ast.Compare):
            if len(node.ops) != 1:
                continue
            for side, other in ((node.left, node.comparators[0]), (node.comparators[0], node.left)):
                limit = number(other, known)
                if limit is None or limit <= 0 or not DISTANCE.search(unparse(side)):
                    continue
                if limit >= FARTHEST or limit <= NEAREST:
                    what = "takes all posts nearer than that to each other for one"
                    if limit <= NEAREST:
                        what = "takes one post for several, because depth and heading have errors"
                    yield (
                        node,
                        f"{unparse(node)[:60]} with {limit:g} m {what}: distances are in metres, and the posts "
                        "are thin",
                    )


def _measures(function: ast.FunctionDef, tree: ast.AST, name: str) -> set[str]:
    """Return the names in a function that hold a distance, or a direction, of a place."""
    found = {unparse(target) for target, value in assigned(function) if _is_measure(value, set(), name)}
    rows = {
        listed: call.args[0] for _, call, listed in kept(tree) if call.args and _is_measure(call.args[0], found, name)
    }
    for node in nodes_of(function, ast.For, ast.comprehension):
        if unparse(node.iter) in rows:
            found.add(unparse(node.target))
    return found


def _is_measure(node: ast.expr, names: set[str], name: str) -> bool:
    """Say whether an expression is a distance, or a direction, of one place from the robot."""
    if unparse(node) in names:
        return True
    if not isinstance(node, ast.Call) or last_name(node.func) not in MEASURES[name]:
        return False
    return not any(isinstance(each, ast.Sub) for each in walk(node))  # else it is between two places


def _all_compared(function: ast.FunctionDef) -> int:
    """Return how many comparisons with < or > a function has."""
    return sum(
        isinstance(node, ast.Compare) and isinstance(node.ops[0], ast.Lt | ast.LtE | ast.Gt | ast.GtE)
        for node in walk(function)
    )


@suspicion_of(About.SAME)
def emptied(tree: ast.AST) -> Words:
    """Find a list whose length is published, and that is emptied in the run."""
    spoken = {
        unparse(call.args[0])
        for each, name in calls(tree)
        if name == "publish"
        for call, inner in calls(each)
        if inner == "len" and call.args and isinstance(call.args[0], ast.Attribute)
    }
    for function in functions(tree):
        if function.name == "__init__":
            continue
        for target, value in assigned(function):
            if unparse(target) in spoken and isinstance(value, ast.List) and not value.elts:
                yield (
                    value,
                    f"{unparse(target)} is emptied here again and again, and its length is published: count the "
                    "posts of the whole turn",
                )


@suspicion_of(About.ONE_PICTURE)
def of_one_picture(tree: ast.AST) -> Words:
    """Find a number that is published, and that is how long a list is which each picture makes anew."""
    spoken = {unparse(each.value) for each in nodes_of(tree, ast.keyword) if each.arg == "data"}
    spoken |= {unparse(value) for target, value in assigned(tree) if unparse(target).endswith(".data")}
    for function in functions(tree):
        if function.name == "__init__":
            continue
        made = {unparse(target) for target, value in assigned(function) if isinstance(value, ast.List | ast.ListComp)}
        for target, value in assigned(function):
            of = [call for call, name in calls(value) if name == "len" and call.args]
            name = unparse(target)
            if name in spoken and name.startswith("self.") and of and unparse(of[0].args[0]) in made:
                yield (
                    value,
                    f"{name} = {unparse(value)[:50]} counts {unparse(of[0].args[0])}, which begins empty in "
                    "each picture: count the posts of the whole turn",
                )
