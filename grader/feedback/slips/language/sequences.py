"""Lists, generators, comparisons and logs that are not what a beginner takes them for."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import (
    Place,
    Words,
    last_name,
    left_early,
    nodes_of,
    unparse,
    walk,
)
from gz_course.grader.feedback.slips import slip, slip_of

BEFORE = ("not_what_they_seem",)

READ_ONCE = frozenset({"filter", "map", "zip", "reversed", "iter", "enumerate"})
READERS = frozenset({
    "sum", "min", "max", "list", "tuple", "sorted", "set", "len", "mean", "fmean", "median", "array", "fsum",
})  # fmt: skip
CHANGES = frozenset({"remove", "pop", "insert"})
LEVELS = frozenset({"debug", "info", "warn", "warning", "error", "fatal"})


def assigned(function: ast.FunctionDef) -> dict[str, list[ast.expr | None]]:
    """Return what is assigned to each name, in order; None for a loop variable or another change."""
    found: dict[str, list[ast.expr | None]] = {}
    for node in walk(function):
        if isinstance(node, ast.Assign) and len(node.targets) == 1 and isinstance(node.targets[0], ast.Name):
            found.setdefault(node.targets[0].id, []).append(node.value)
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            found.setdefault(node.id, [])
        elif isinstance(node, ast.AugAssign):
            found.setdefault(unparse(node.target), []).append(None)
    return found


@slip_of(ast.FunctionDef)
def read_twice(function: ast.FunctionDef) -> Words:
    """Find a generator, or what filter() and map() return, that is read to its end twice."""
    for name, values in assigned(function).items():
        value = values[0] if len(values) == 1 else None
        what = "a generator" if isinstance(value, ast.GeneratorExp) else ""
        if isinstance(value, ast.Call) and isinstance(value.func, ast.Name) and value.func.id in READ_ONCE:
            what = f"what {value.func.id}() returns"
        readers = sorted(_readers(function, name), key=lambda node: (node.lineno, node.col_offset)) if what else []
        if len(readers) > 1:
            yield (
                readers[1],
                f"{name} is {what}, which can be read only once: line {readers[0].lineno} has read it to its end, "
                "and here it is empty; make a list, [... for ... in ...] or list(...)",
            )


def _readers(function: ast.FunctionDef, name: str) -> Iterator[ast.expr]:
    for node in walk(function):
        if isinstance(node, ast.Call) and last_name(node.func) in READERS:
            yield from (each for each in node.args if isinstance(each, ast.Name) and each.id == name)
        elif isinstance(node, ast.For | ast.comprehension) and unparse(node.iter) == name:
            ends = isinstance(node, ast.For) and left_early(node)
            if not ends:
                yield node.iter


@slip_of(ast.For)
def changed_while_read(loop: ast.For) -> Words:
    """Find a loop over a list that takes elements out of the same list, and goes on."""
    over = loop.iter
    if isinstance(over, ast.Call) and last_name(over.func) == "enumerate" and over.args:
        over = over.args[0]
    if not isinstance(over, ast.Name | ast.Attribute):
        return
    name = unparse(over)
    for node in walk(loop):
        call = isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in CHANGES
        taken = call and unparse(node.func.value) == name  # type: ignore[attr-defined]
        if isinstance(node, ast.Delete):
            taken = any(isinstance(each, ast.Subscript) and unparse(each.value) == name for each in node.targets)
        if taken and not _leaves_after(loop.body, node):
            yield (
                node,
                f"this changes {name} while the loop in line {loop.lineno} runs over it: what follows moves up, so "
                "the loop skips the next element; make a new list of those that are to stay",
            )
            break


def _leaves_after(block: list[ast.stmt], node: ast.AST) -> bool:
    """Return whether a loop is left for certain after a node in one of its blocks."""
    for number, statement in enumerate(block):
        if any(each is node for each in walk(statement)):
            later = block[number:]
            inner = (getattr(statement, part, []) for part in ("body", "orelse", "finalbody"))
            return any(isinstance(each, ast.Break | ast.Return) for each in later) or any(
                _leaves_after(each, node) for each in inner if isinstance(each, list)
            )
    return False


@slip_of(ast.Compare)
def compared_with_nan(node: ast.Compare) -> Words:
    """Find comparisons that are always the same: with nan by value, with a float by identity."""
    for left, operator, right in zip([node.left, *node.comparators], node.ops, node.comparators, strict=False):
        kinds = {_constant(side) for side in (left, right)}
        if isinstance(operator, ast.Eq | ast.NotEq) and "nan" in kinds:
            yield "nothing is equal to nan, not even nan itself: math.isnan(x) asks for it"
        elif isinstance(operator, ast.Is | ast.IsNot) and kinds & {"nan", "inf"}:
            yield (
                "`is` asks for the same object, not for the same value: math.isinf(x) and math.isnan(x) ask for "
                "inf and nan"
            )


def _constant(node: ast.expr) -> str:
    """Return `inf` or `nan` for math.inf, float('nan') and the like; empty for anything else."""
    text = unparse(node).replace('"', "'").lower().lstrip("+-")
    names = {f"{module}.{name}": name for module in ("math", "np", "numpy") for name in ("inf", "nan")}
    names |= {f"float('{sign}{name}')": name for sign in ("", "-", "+") for name in ("inf", "nan")}
    return names.get(text, "")


@slip
def log_arguments(tree: ast.AST) -> Iterator[Place]:
    """Find a line of the node's logger with several arguments, as print() and Python's logging take them."""
    loggers = {
        unparse(node.targets[0]) for node in nodes_of(tree, ast.Assign) if unparse(node.value).endswith("get_logger()")
    }
    for node in nodes_of(tree, ast.Call):
        if not isinstance(node.func, ast.Attribute) or node.func.attr not in LEVELS:
            continue
        owner = unparse(node.func.value)
        if len(node.args) > 1 and (owner.endswith("get_logger()") or owner in loggers):
            yield (
                node.lineno,
                f"{node.func.attr}() of the node's logger takes one text, and no values to fill in: write an f-string, "
                "or put the values in with  '...' % (...)",
            )
