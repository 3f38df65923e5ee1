"""Suspects in averages over time that a node steers by: what it answers is old."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.constants import named_numbers, number
from gz_course.grader.feedback.facts.syntax import Words, assigned, calls, functions, last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion, suspicion_of
from gz_course.grader.feedback.suspects.about import About, Suspect

MANY = 8  # values of a mean
MEANS = ("mean", "fmean", "average", "median", "sum", "nanmean", "nanmedian")
ADDS = ("append", "appendleft", "insert", "extend")
LITTLE = 0.15  # the weight of a new value in a moving average
WORDS = (
    "smooths over many scans, so the feedback comes late: the robot answers what the lidar saw some time ago, turns "
    "too late, and swings; use each scan as it comes, or smooth much less"
)


@suspicion_of(About.DELAY)
def means_over_time(tree: ast.Module) -> Words:
    """Find the mean of the last values that an attribute keeps from scan to scan."""
    if "angular.z" not in unparse(tree) or "LaserScan" not in unparse(tree):
        return
    sizes = _sizes(tree)
    for call, name in calls(tree):
        if name not in MEANS:
            continue
        of = [call.func.value] if isinstance(call.func, ast.Attribute) and not call.args else call.args[:1]
        read = [unparse(each) for given in of for each in nodes_of(given, ast.Attribute)]
        kept = next((each for each in read if sizes.get(each, 0) >= MANY), "")
        if kept:
            yield call, f"{unparse(call)[:60]}, of the last {sizes[kept]:g} values, {WORDS}"


def _sizes(tree: ast.Module) -> dict[str, float]:
    """Return how many values each attribute that collects some keeps at most, as far as that is written."""
    known, found = named_numbers(tree), {}
    kept = {
        unparse(call.func.value)
        for call, name in calls(tree)
        if name in ADDS and isinstance(call.func, ast.Attribute) and isinstance(call.func.value, ast.Attribute)
    }
    text = unparse(tree)
    for target, _ in assigned(tree):  # an array that is filled in turn
        if isinstance(target, ast.Subscript) and ("%" in unparse(target.slice) or "roll(" in text):
            kept.add(unparse(target.value))
    for target, value in assigned(tree):
        name = unparse(target)
        if isinstance(target, ast.Attribute) and isinstance(value, ast.Subscript) and name in unparse(value.value):
            if isinstance(value.slice, ast.Slice) and value.slice.lower is not None:
                last = number(value.slice.lower, known)  # self.x = (self.x + [new])[-15:]
                found[name] = -last if last is not None and last < 0 else None
        elif name in kept:
            match value:
                case ast.Call() if last_name(value.func) == "deque":
                    given = [each.value for each in value.keywords if each.arg == "maxlen"] + value.args[1:2]
                    found[name] = number(given[0], known) if given else None
                case ast.Call(args=[size, *_]) if last_name(value.func) in ("zeros", "ones", "full"):
                    found[name] = number(size, known)
                case ast.BinOp(left=ast.List(), op=ast.Mult(), right=size):
                    found[name] = number(size, known)
    for node in nodes_of(tree, ast.Compare):
        if re.match(r"len\((.+)\)$", unparse(node.left)):
            name = unparse(node.left)[4:-1]
            if name in kept:
                found[name] = number(node.comparators[0], known)
    return {name: size for name, size in found.items() if size is not None}


@suspicion
def moving_averages(tree: ast.Module) -> Iterator[Suspect]:
    """Find an attribute of which most is kept from scan to scan: `self.x = 0.95 * self.x + 0.05 * new` and the like."""
    if "angular.z" not in unparse(tree) or "LaserScan" not in unparse(tree):
        return
    known = named_numbers(tree)
    for function in functions(tree):
        stored = {unparse(value): unparse(target) for target, value in assigned(function)}
        asked = {
            text
            for target, value in assigned(function)
            if "get_parameter(" in unparse(value) and "distance" in unparse(value)
            for text in (unparse(target), unparse(value))
        } | {unparse(call) for call, name in calls(function) if name == "get_parameter"}
        for node in walk(function):
            if isinstance(node, ast.AugAssign) and isinstance(node.op, ast.Add):
                name, share = unparse(node.target), _share_of_step(node.value, unparse(node.target), known)
            elif isinstance(node, ast.Assign) and len(node.targets) == 1:
                name = unparse(node.targets[0])
                name = name if name.startswith("self.") else stored.get(name, "")  # new = ...; self.x = new
                share = _share(node.value, name, known)
            else:
                continue
            if share is None or not 0 < share <= LITTLE or not name.startswith("self."):
                continue
            if asked & {unparse(each) for each in nodes_of(node.value, ast.Name, ast.Call)}:
                yield (
                    node.lineno,
                    About.SELDOM_DISTANCE,
                    f"{unparse(node)[:70]} lets a new value of the parameter take effect over many scans, and it "
                    "must at once: use the parameter itself",
                )
            else:
                yield node.lineno, About.DELAY, f"{unparse(node)[:70]} {WORDS}"


def _share(value: ast.expr, name: str, known: dict[str, int | float]) -> float | None:
    """Return the weight of what is new in a value that is made of it and of `name`; None for anything else."""
    match value:
        case ast.BinOp(op=ast.Add(), left=left, right=right):
            if unparse(left) == name:
                return _share_of_step(right, name, known)
            return _weight(left, right, name, known) or _weight(right, left, name, known)
        case ast.BinOp(op=ast.Div(), left=ast.BinOp(op=ast.Add(), left=left, right=right), right=whole):
            total = number(whole, known)  # (19 * self.x + new) / 20
            for old, new in ((left, right), (right, left)):
                factor = _factor(old, name, known)
                if total and factor is not None and name not in unparse(new) and abs(total - factor - 1) < 1e-6:
                    return 1 / total
    return None


def _share_of_step(product: ast.expr, name: str, known: dict[str, int | float]) -> float | None:
    """Return the factor of `factor * (new - name)`, or the inverse of what the difference is divided by."""
    if not isinstance(product, ast.BinOp) or not isinstance(product.op, ast.Mult | ast.Div):
        return None
    for factor, step in ((product.left, product.right), (product.right, product.left)):
        if isinstance(step, ast.BinOp) and isinstance(step.op, ast.Sub) and unparse(step.right) == name:
            share = number(factor, known)
            if isinstance(product.op, ast.Mult):
                return share
            return 1 / share if share and step is product.left else None
    return None


def _factor(product: ast.expr, name: str, known: dict[str, int | float]) -> float | None:
    """Return the number by which `name` is multiplied; None for another expression."""
    if not isinstance(product, ast.BinOp) or not isinstance(product.op, ast.Mult):
        return None
    pairs = ((product.left, product.right), (product.right, product.left))
    return next((number(factor, known) for factor, held in pairs if unparse(held) == name), None)


def _weight(old: ast.expr, new: ast.expr, name: str, known: dict[str, int | float]) -> float | None:
    """Return the weight of what is new where an expression keeps most of a name; None for anything else."""
    weight = _factor(old, name, known)
    if weight is None or not isinstance(new, ast.BinOp) or not isinstance(new.op, ast.Mult):
        return None
    given = [number(each, known) for each in (new.left, new.right)]
    return 1 - weight if any(each is not None and abs(each + weight - 1) < 1e-6 for each in given) else None


def _worked_off(tree: ast.AST, kept: str) -> set[int]:
    """Return the nodes of loops that go on until nothing is kept: they take each value, the oldest first."""
    loops = (each for each in nodes_of(tree, ast.While, ast.For))
    conditions = ((each, each.test if isinstance(each, ast.While) else each.iter) for each in loops)
    return {id(node) for each, condition in conditions if kept in unparse(condition) for node in walk(each)}


@suspicion_of(About.DELAY)
def delay_lines(tree: ast.Module) -> Words:
    """Find the oldest of many values, taken where the newest is meant: `self.last.popleft()`, `self.last[0]`."""
    if "angular.z" not in unparse(tree) or "LaserScan" not in unparse(tree):
        return
    text, sizes = unparse(tree), _sizes(tree)
    for node in nodes_of(tree, ast.Assign):
        value = node.value
        value = value.body if isinstance(value, ast.IfExp) else value
        oldest = ""
        match value:
            case ast.Call(func=ast.Attribute(value=kept, attr="popleft"), args=[]):
                oldest = unparse(kept)
            case ast.Call(func=ast.Attribute(value=kept, attr="pop"), args=[ast.Constant(value=0)]):
                oldest = unparse(kept)
            case ast.Subscript(value=kept, slice=ast.Constant(value=0)):
                oldest = unparse(kept)
        if sizes.get(oldest, 0) < MANY // 2 or id(node) in _worked_off(tree, oldest):
            continue
        if not any(part in text for part in (f"{oldest}[-1]", f"{oldest}.appendleft", f"{oldest}.insert")):
            yield (
                value,
                f"{unparse(value)[:60]} is the oldest of {sizes[oldest]:g} values, so the robot answers what the "
                "lidar saw that many scans ago, turns too late, and swings; use the newest",
            )
