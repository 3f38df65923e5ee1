"""Suspects in how the bias of a gyroscope is used: as an angle instead of a rate, as a sum, or not at all."""

from __future__ import annotations

import ast
import re

from gz_course.grader.feedback.facts.syntax import Words, assigned, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About
from gz_course.grader.feedback.suspects.sensing.gyroscopes import angle_sums, assigned_once, expanded, reads_rates

BIAS = re.compile(r"(?:^|[._])(?:\w*bias\w*|offset|drift)$", re.IGNORECASE)


def _biases(node: ast.AST) -> set[str]:
    """Return the names in an expression that stand for a bias."""
    parts = (unparse(each) for each in nodes_of(node, ast.Name, ast.Attribute))
    return {each for each in parts if BIAS.search(each)}


@suspicion_of(About.GYROSCOPE)
def subtracted_as_an_angle(tree: ast.AST) -> Words:
    """Find a bias [rad/s] that is taken from the heading [rad], once or in each step without a time."""
    sums = [found for function in reads_rates(tree) for found in angle_sums(function)]
    for node, _, value, whole in sums:
        if (
            isinstance(whole, ast.BinOp)
            and isinstance(whole.op, ast.Sub)
            and isinstance(value, ast.BinOp)
            and isinstance(whole.left, ast.BinOp)
            and isinstance(whole.left.op, ast.Mult)
            and isinstance(value.right, ast.Name | ast.Attribute)
            and _biases(value.right)
        ):
            yield (
                node,
                f"{unparse(node)[:70]} subtracts the bias, a rate [rad/s], from an angle [rad]: (rate - bias) * time",
            )
    for name in {name for _, name, _, _ in sums}:
        if any(_biases(whole) or _biases(value) for _, each, value, whole in sums if each == name):
            continue
        for target, value in assigned(tree):
            if unparse(target) == name and _biases(value) and "angular_velocity" not in unparse(value):
                yield (
                    value,
                    f"{name} gets {unparse(value)[:40]}: the bias is taken from the angle [rad], once, but it is a "
                    "rate [rad/s], wrong in every message: add (rate - bias) * time each time",
                )


@suspicion_of(About.GYROSCOPE)
def never_used(tree: ast.AST) -> Words:
    """Find a bias that is measured, and read nowhere but where it is measured."""
    if not any(True for _ in reads_rates(tree)):
        return
    for name in sorted({unparse(t) for t, _ in assigned(tree) if isinstance(t, ast.Name | ast.Attribute)}):
        if not BIAS.search(name):
            continue
        places = [value for target, value in assigned(tree) if unparse(target) == name]
        own = {id(each) for value in places for each in walk(value)}
        tail = name.rpartition(".")[2]
        read = any(
            isinstance(each, ast.Name | ast.Attribute)
            and isinstance(each.ctx, ast.Load)
            and unparse(each).rpartition(".")[2] == tail
            and id(each) not in own
            for each in walk(tree)
        )
        measured = [value for value in places if not isinstance(value, ast.Constant)]
        if not read and measured:
            yield measured[0], f"{name} is measured here and subtracted nowhere: add (rate - {name}) * time"


@suspicion_of(About.GYROSCOPE)
def sums_for_means(tree: ast.AST) -> Words:
    """Find a running sum of the standing rates that is subtracted as the bias, and divided nowhere."""
    sums = {
        unparse(node.target): node
        for function in reads_rates(tree)
        for node in nodes_of(function, ast.AugAssign)
        if isinstance(node.op, ast.Add) and _is_rate(node.value, function)
    }
    divided = " ".join(
        unparse(node.left if isinstance(node, ast.BinOp) else node.target)
        for node in nodes_of(tree, ast.BinOp, ast.AugAssign)
        if isinstance(node.op, ast.Div)
    )
    for node in nodes_of(tree, ast.BinOp):
        if isinstance(node.op, ast.Sub):
            made = sums.get(unparse(node.right))
            if made is not None and unparse(node.right) not in divided:
                yield (
                    made,
                    f"{unparse(made)[:60]} is the sum of the rates, and it is subtracted as their mean: divide it "
                    "by their number",
                )


def _is_rate(value: ast.expr, function: ast.FunctionDef) -> bool:
    """Say whether an expression is a turning rate alone, with no time beside it."""
    return unparse(expanded(value, assigned_once(function))).endswith("angular_velocity.z")
