"""Suspects in planning: searches that go deep first, ways that run backwards or are never shortened, old poses."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import (
    Words,
    assigned,
    called,
    calls,
    children,
    functions,
    kept,
    last_name,
    nodes_of,
    unparse,
    walk,
)
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About
from gz_course.grader.feedback.suspects.steering.headings import HEADING

SHORTENS = frozenset({"pop", "popleft", "remove", "clear"})
COLLECTS = frozenset({"append", "insert", "appendleft"})
TURNS_ROUND = frozenset({"reverse", "reversed", "insert", "appendleft"})
SMALL = re.compile(r"\bu?int8\b|['\"][iu]1['\"]")
HOLDS = frozenset({"clip", "minimum", "maximum", "min", "max"})
AIMED = frozenset({"atan2", "arctan2"})


@suspicion_of(About.CELL)
def aimed_from_the_origin(tree: ast.AST) -> Words:
    """Find the direction of a place from the origin where that from the robot is meant: no pose is subtracted."""
    poses = {unparse(target) for target, value in assigned(tree) if unparse(value).endswith((".position.x", "p.x"))}
    makers = {each.name for each in functions(tree) if not any(pose in unparse(each) for pose in poses)}
    for function in functions(tree) if poses else ():
        places: dict[str, int] = {}
        for target, value in assigned(function):
            made = isinstance(value, ast.Call) and last_name(value.func) in makers and len(value.args) == 1
            for each in target.elts if isinstance(target, ast.Tuple) and (made or _of_a_path(value)) else ():
                places[unparse(each)] = value.lineno
        for call, name in calls(function):
            texts = [unparse(each) for each in call.args]
            if name in AIMED and len(texts) == 2 and all(text in places for text in texts):
                yield (
                    call,
                    f"{unparse(call)} is the direction of ({texts[1]}, {texts[0]}) from the origin of the map, "
                    "not from the robot: subtract the robot's x and y first",
                )


def _set(tree: ast.AST) -> Iterator[tuple[ast.expr, ast.expr]]:
    return ((target, value) for target, value in assigned(tree) if isinstance(value, ast.Name | ast.Tuple))


@suspicion_of(About.PART, ast.FunctionDef)
def part_of_a_scan(function: ast.FunctionDef) -> Words:
    """Find a loop that goes through a part of the rays while it draws a map."""
    for loop in nodes_of(function, ast.For):
        for node in walk(loop.iter):
            part = isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Slice) and node.slice.step is None
            if isinstance(node, ast.Subscript) and part and unparse(node.value).endswith(".ranges"):
                yield (
                    node,
                    f"{unparse(node)[:60]} leaves out a part of the rays: what stands on that side never gets "
                    "into the map",
                )


@kept
def _from_the_end(tree: ast.AST) -> bool:
    """Return whether a function takes the last cell of a way, and does not go through it from its first one."""
    for function in functions(tree):
        ends = {unparse(each.value) for each in nodes_of(function, ast.Subscript) if unparse(each).endswith("[-1]")}
        loops = {unparse(each.iter) for each in nodes_of(function, ast.For)}
        if ends - loops:
            return True
    return False


@suspicion_of(About.SEARCH, ast.FunctionDef)
def depth_first(function: ast.FunctionDef) -> Words:
    """Find a search for a way that goes on from the cell that was added last."""
    for loop in nodes_of(function, ast.While):
        for target, value in assigned(loop):
            if not isinstance(value, ast.Call) or last_name(value.func) != "pop" or value.args:
                continue
            queue = unparse(value.func).rpartition(".")[0]
            names = {each.id for each in nodes_of(target, ast.Name)}
            added = any(unparse(call.func) == f"{queue}.append" for call, _ in calls(loop))
            kept = any(isinstance(one, ast.Subscript) and unparse(other) in names for one, other in _set(loop))
            if queue in unparse(loop.test) and added and kept:
                yield (
                    value,
                    f"{unparse(value)} takes the newest cell of {queue}, so the search runs deep before it "
                    "looks around: its ways wind and lead to some goal, not to the nearest; the oldest cell, "
                    "popleft() of a deque, gives the shortest way",
                )


def _planners(owner: ast.ClassDef, way: str) -> set[str]:
    """Return the methods that collect a way cell by cell in an attribute themselves."""
    return {
        one.name
        for one in functions(owner)
        if one.name != "__init__"
        and any(unparse(target) == way for target, _ in assigned(one))
        and (called(one) & COLLECTS)
        and any(isinstance(each, ast.While) for each in walk(one))
    }


@suspicion_of(About.WAY, ast.FunctionDef)
def backwards(function: ast.FunctionDef, tree: ast.AST) -> Words:
    """Find a way that is followed back from its goal to the start, and not turned round."""
    if called(function) & TURNS_ROUND or "[::-1]" in unparse(function) or _from_the_end(tree):
        return
    for loop in nodes_of(function, ast.While):
        steps = {
            unparse(target)
            for target, value in assigned(loop)
            if isinstance(value, ast.Subscript) and unparse(value.slice) == unparse(target)
        }
        for call, name in calls(loop):
            if name == "append" and call.args and unparse(call.args[0]) in steps:
                way = unparse(call.func).rpartition(".")[0]
                ahead = ("pop()", "[::-1]", "reverse", "[len(")
                if not any(each in unparse(tree) for each in ahead):
                    yield (
                        call,
                        f"{unparse(call)} collects the way from the goal back to the start, and nothing turns "
                        f"it round: its first cells are those at the goal; {way}.reverse() makes it begin here",
                    )


@suspicion_of(About.WAY, ast.ClassDef)
def never_shortened(owner: ast.ClassDef) -> Words:
    """Find a way that is planned only while there is none, and of which no cell is ever taken out."""
    for node in nodes_of(owner, ast.If):
        match node.test:
            case ast.UnaryOp(op=ast.Not(), operand=ast.Attribute() as kept):
                way = unparse(kept)
            case ast.Compare(left=ast.Attribute() as kept, comparators=[ast.Constant(value=None)]):
                way = unparse(kept)
            case ast.Compare(left=ast.Call(func=ast.Name(id="len"), args=[kept]), comparators=[ast.Constant(value=0)]):
                way = unparse(kept)
            case _:
                continue
        planners = _planners(owner, way)
        in_test = {id(each) for part in node.body for each in walk(part)}
        there = {id(each) for one in functions(owner) if one.name in planners for each in walk(one)}
        planned = any(
            unparse(target) == way
            and isinstance(value, ast.Call)
            and last_name(value.func) in {one.name for one in functions(owner) if called(one) & COLLECTS}
            for target, value in assigned(node)
        )
        calls_planner = planners & called(node)
        # Whatever changes the way anywhere but where it is planned may take cells out of it.
        inside = (
            in_test | there | {id(each) for one in functions(owner) if one.name == "__init__" for each in walk(one)}
        )
        others = [
            target for target, _ in assigned(owner) if unparse(target).startswith(way) and id(target) not in inside
        ]
        shortened = any(
            name in SHORTENS and unparse(call.func).startswith(f"{way}.") and id(call) not in there
            for call, name in calls(owner)
        )
        deleted = any(isinstance(each, ast.Delete) and way in unparse(each) for each in walk(owner))
        followed = any(isinstance(each, ast.Subscript) and unparse(each.value) == way for each in walk(owner))
        again = calls_planner and any(
            last_name(call.func) in calls_planner and id(call) not in in_test for call, _ in calls(owner)
        )
        if (planned or calls_planner) and followed and not (others or shortened or deleted or again):
            yield (
                node,
                f"{way} is planned only while it is empty, and nothing takes a cell out of it: the robot goes for "
                "the same cell for ever. Take out the cells that are reached, or plan again each time",
            )


@suspicion_of(About.POSE, ast.FunctionDef)
def first_pose(function: ast.FunctionDef, tree: ast.AST) -> Words:
    """Find a callback that returns if it has a pose already, and so keeps that of its first message."""
    if ".pose.pose." not in unparse(function):
        return
    for node in function.body:
        if not isinstance(node, ast.If) or not isinstance(node.body[-1], ast.Return):
            continue
        match node.test:
            case ast.Compare(left=ast.Attribute() as kept, ops=[ast.IsNot()], comparators=[ast.Constant()]):
                pass
            case ast.Attribute() as kept:
                pass
            case _:
                continue
        name = unparse(kept)
        later = {
            unparse(part)
            for target, _ in assigned(function)
            if target.lineno > node.lineno
            for part in nodes_of(target, ast.Attribute)
        }
        elsewhere = any(
            unparse(target) == name
            for other in functions(tree)
            for target, _ in assigned(other)
            if other is not function and other.name != "__init__"
        )
        if name in later and not elsewhere:
            yield (
                node,
                f"{function.name} returns here once {name} is set, so the pose is that of the first message for "
                "ever, and the map and the ways do not move with the robot: set it in every call",
            )


def _sign(node: ast.expr, name: str, values: dict[str, ast.expr]) -> int:
    """Return the sign with which a name goes into an expression, by its operators and constants; 0 if it is not in it.

    A gain with a name is what it was assigned, or positive.
    """
    if unparse(node) == name:
        return 1
    match node:
        case ast.UnaryOp(op=ast.USub(), operand=inner):
            return -_sign(inner, name, values)
        case ast.BinOp(left=left, op=op, right=right):
            one, other = _sign(left, name, values), _sign(right, name, values)
            if isinstance(op, ast.Mult | ast.Div):
                gain = right if one else left
                text = unparse(values.get(unparse(gain), gain))
                return (one or other) * (-1 if text.startswith("-") else 1)
            return one or (-other if isinstance(op, ast.Sub) else other)
    return next(
        (sign for each in children(node) if isinstance(each, ast.expr) and (sign := _sign(each, name, values))),
        0,
    )


@suspicion_of(About.COUNTER)
def small_counters(tree: ast.AST) -> Words:
    """Find an array of 8 bits in which something is counted."""
    small = {
        unparse(target): value.lineno
        for target, value in assigned(tree)
        if isinstance(value, ast.Call) and SMALL.search(unparse(value)) and last_name(value.func) != "astype"
    }
    for function in functions(tree):
        limited = {unparse(each) for call, name in calls(function) if name in HOLDS for each in walk(call)}
        for node in walk(function):
            name = ""
            if isinstance(node, ast.AugAssign) and isinstance(node.target, ast.Subscript | ast.Attribute):
                whole = node.target.value if isinstance(node.target, ast.Subscript) else node.target
                while isinstance(whole, ast.Subscript):
                    whole = whole.value
                name = unparse(whole)
            elif isinstance(node, ast.Call) and unparse(node.func).endswith("add.at") and node.args:
                name = unparse(node.args[0])
            if name in small and name not in limited:
                yield (
                    node,
                    f"{name} has numbers of 8 bits (line {small[name]}), which begin again at the other end when a "
                    "count passes 127 (int8) or 255 (uint8), and near the robot many rays pass a cell: count with "
                    "larger integers, dtype=int",
                )
                return


def _of_a_path(value: ast.expr) -> bool:
    return isinstance(value, ast.Subscript) and bool(re.search(r"path|way|route|plan|cells", unparse(value.value)))


@suspicion_of(About.SIGN)
def turned_the_wrong_way(tree: ast.AST) -> Words:
    """Find an error that is the heading minus the direction of the goal, and turns the robot with a positive gain."""
    values = {unparse(target): value for target, value in assigned(tree)}
    aimed = {
        name for name, value in values.items() if called(value) & AIMED and not re.search(r"\.[wz]\b", unparse(value))
    }
    for target, value in assigned(tree):
        for node in nodes_of(value, ast.BinOp):
            if not isinstance(node.op, ast.Sub):
                continue
            left, right = unparse(node.left), unparse(node.right)
            backward = isinstance(node.left, ast.Attribute | ast.Name) and HEADING.search(left) and left not in aimed
            if not backward or not (right in aimed or right.startswith(("atan2(", "math.atan2(", "np.arctan2("))):
                continue
            error = unparse(target)
            used = [
                other
                for one, other in assigned(tree)
                if unparse(one).endswith("angular.z") and error in {unparse(each) for each in walk(other)}
            ]
            if used and all(_sign(each, error, values) > 0 for each in used):
                yield (
                    node,
                    f"{unparse(node)[:60]} is the error with the wrong sign, and angular.z turns by it: the robot "
                    "turns away from its goal; it is the direction of the goal minus the heading",
                )


@suspicion_of(About.CELL)
def cells_for_metres(tree: ast.AST) -> Words:
    """Find a cell of a way from which a place in metres is subtracted."""
    poses = {unparse(target) for target, value in assigned(tree) if unparse(value).endswith((".position.x", "p.x"))}
    cells: dict[str, str] = {}
    for target, value in assigned(tree):
        if _of_a_path(value) and isinstance(target, ast.Tuple):
            cells |= {each.id: unparse(value) for each in target.elts if isinstance(each, ast.Name)}
    for node in nodes_of(tree, ast.BinOp):
        if isinstance(node.op, ast.Sub) and unparse(node.right) in poses:
            name = unparse(node.left)
            if name in cells:
                yield (
                    node,
                    f"{unparse(node)} subtracts metres from {name}, which comes from {cells[name][:40]}: if these "
                    "are cells, make metres of them first, corner + (cell + 0.5) * resolution",
                )
