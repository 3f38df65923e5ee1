"""Suspects in averages over time that a node steers by: what it answers is old."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.lint.constants import named_numbers, number
from gz_course.grader.lint.syntax import Suspect, assigned, calls, functions, last_name, walk

MANY = 8  # values of a mean
LITTLE = 0.15  # the weight of a new value in a moving average
WORDS = (
    "smooths over many scans, so the feedback comes late: the robot answers what the lidar saw some time ago, turns "
    "too late, and swings; use each scan as it comes, or smooth much less"
)


def means_over_time(tree: ast.Module) -> Iterator[Suspect]:
    """Find the mean of the last values that an attribute keeps from scan to scan."""
    if "angular.z" not in ast.unparse(tree) or "LaserScan" not in ast.unparse(tree):
        return
    kept = {
        ast.unparse(call.func.value)
        for call, name in calls(tree)
        if name == "append" and isinstance(call.func, ast.Attribute) and isinstance(call.func.value, ast.Attribute)
    }
    sizes = _sizes(tree, kept)
    for call, name in calls(tree):
        if name not in ("mean", "fmean", "average", "median", "sum") or not call.args:
            continue
        of = ast.unparse(call.args[0]).partition("[")[0]
        if of in kept and sizes.get(of, 0) >= MANY:
            yield call.lineno, "delay", f"{ast.unparse(call)[:60]}, of the last {sizes[of]:g} values, {WORDS}"


def _sizes(tree: ast.Module, kept: set[str]) -> dict[str, float]:
    """Return how many values each of some lists keeps at most, as far as that is written."""
    known, found = named_numbers(tree), {}
    for target, value in assigned(tree):
        name = ast.unparse(target)
        if name in kept and isinstance(value, ast.Call) and last_name(value.func) == "deque":
            given = [each.value for each in value.keywords if each.arg == "maxlen"] + value.args[1:2]
            found[name] = number(given[0], known) if given else None
    for node in walk(tree):
        if isinstance(node, ast.Compare) and re.match(r"len\((.+)\)$", ast.unparse(node.left)):
            name = ast.unparse(node.left)[4:-1]
            if name in kept:
                found[name] = number(node.comparators[0], known)
    return {name: size for name, size in found.items() if size is not None}


def moving_averages(tree: ast.Module) -> Iterator[Suspect]:
    """Find `self.x = 0.95 * self.x + 0.05 * new` and `self.x += 0.05 * (new - self.x)`."""
    if "angular.z" not in ast.unparse(tree) or "LaserScan" not in ast.unparse(tree):
        return
    known = named_numbers(tree)
    for function in functions(tree):
        for node in walk(function):
            share = None
            match node:
                case ast.AugAssign(target=target, op=ast.Add(), value=ast.BinOp(op=ast.Mult()) as product):
                    share = _share_of_step(product, ast.unparse(target), known)
                case ast.Assign(targets=[target], value=ast.BinOp(op=ast.Add(), left=left, right=right)):
                    name = ast.unparse(target)
                    share = _weight(left, right, name, known) or _weight(right, left, name, known)
                case _:
                    continue
            if share is not None and 0 < share <= LITTLE and isinstance(target, ast.Attribute):
                yield node.lineno, "delay", f"{ast.unparse(node)[:70]} {WORDS}"


def _share_of_step(product: ast.BinOp, name: str, known: dict[str, int | float]) -> float | None:
    for factor, step in ((product.left, product.right), (product.right, product.left)):
        if isinstance(step, ast.BinOp) and isinstance(step.op, ast.Sub) and ast.unparse(step.right) == name:
            return number(factor, known)
    return None


def _weight(old: ast.expr, new: ast.expr, name: str, known: dict[str, int | float]) -> float | None:
    """Return the weight of what is new where an expression keeps most of a name; None for anything else."""
    if not isinstance(old, ast.BinOp) or not isinstance(old.op, ast.Mult) or not isinstance(new, ast.BinOp):
        return None
    for factor, held in ((old.left, old.right), (old.right, old.left)):
        weight = number(factor, known)
        if ast.unparse(held) == name and weight is not None and isinstance(new.op, ast.Mult):
            given = [number(each, known) for each in (new.left, new.right)]
            if any(each is not None and abs(each + weight - 1) < 1e-6 for each in given):
                return 1 - weight
    return None


LOOKS = (means_over_time, moving_averages)
