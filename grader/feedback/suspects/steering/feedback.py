"""Suspects in what feeds a measurement back: means, sums, whole metres, quotients, parameters kept or added."""

from __future__ import annotations

import ast
import re

from gz_course.grader.feedback.facts.syntax import (
    Words,
    assigned,
    functions,
    last_name,
    nodes_of,
    set_to,
    unparse,
    walk,
)
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

ROUNDS = frozenset({"int", "round", "floor", "ceil", "trunc", "rint"})
DEVIATION = re.compile(r"(^|[._])(e|err|error|diff|difference|deviation|offset)\w*$", re.IGNORECASE)
MEANS = frozenset({"mean", "fmean", "average", "nanmean", "median", "nanmedian"})
ERROR = re.compile(
    r"err|integ|self\.(?:sum|total|i)\b", re.IGNORECASE
)  # what the deviation from what is wanted, and its sum, are called
HEADING = re.compile(r"yaw|heading|theta|angle|turned|phi|psi", re.IGNORECASE)  # a sum of rates, not of errors
PARAMETER = re.compile(r"(?:declare|get)_parameter\(")
MEASURED = re.compile(r"\.range$|^min\(.*\branges\b")  # the distance of a Range, and the nearest of a scan
STEPS = 4  # names followed at most
Function = ast.FunctionDef | ast.AsyncFunctionDef


@suspicion_of(About.WHOLE_METRES)
def whole_metres(tree: ast.Module) -> Words:
    """Find a difference of distances that is rounded to whole metres."""
    if not _steers(tree):
        return
    known = set_to(tree)
    for node in walk(tree):
        match node:
            case ast.Call(args=[given], keywords=[]) if last_name(node.func) in ROUNDS:
                values = known.get(unparse(given), [given])
                if all(_is_difference(each) for each in values):
                    yield (
                        node,
                        f"{unparse(node)[:60]} is a whole number of metres: an error below 1 m, or 0.5 m, becomes "
                        "0; leave it as it is",
                    )


@suspicion_of(About.DIVIDED)
def divided(tree: ast.Module) -> Words:
    """Find a gain that is divided by the error instead of multiplied with it."""
    if not _steers(tree):
        return
    known = set_to(tree)
    for node in walk(tree):
        match node:
            case ast.BinOp(op=ast.Div(), left=gain, right=error) if _is_gain(gain):
                values = known.get(unparse(error), [])
                if DEVIATION.search(unparse(error)) and values and all(_is_difference(each) for each in values):
                    yield (
                        node,
                        f"{unparse(node)[:60]} divides by the error: the smaller the error is, the more the robot "
                        "turns; multiply the gain by it",
                    )


def _is_gain(node: ast.expr) -> bool:
    match node:
        case ast.Constant(value=int() | float()):
            return True
        case ast.Name() | ast.Attribute():
            return bool(re.search(r"gain|^k|_k|\bk", unparse(node), re.IGNORECASE))
    return False


def _is_difference(value: ast.expr) -> bool:
    match value:
        case ast.BinOp(op=ast.Sub(), left=left, right=right):
            return not any(isinstance(each, ast.Constant) for each in (left, right)) and "stamp" not in unparse(value)
    return False


def _steers(tree: ast.Module) -> bool:
    text = unparse(tree)
    return "angular.z" in text and ".ranges" in text


def _lists_of_ranges(function: Function) -> set[str]:
    """Return the names of lists that hold ranges of a scan and nothing else."""
    loops = [node for node in nodes_of(function, ast.For, ast.comprehension)]
    single = {name for loop in loops if (name := _range_of(loop))}
    names = {unparse(target) for target, value in assigned(function) if _is_list_of_ranges(value)}
    for node in walk(function):
        match node:
            case ast.Call(func=ast.Attribute(value=kept, attr="append"), args=[ast.Name(id=name)]) if name in single:
                names.add(unparse(kept))
    return names


def _is_list_of_ranges(value: ast.expr) -> bool:
    match value:
        case ast.Attribute(attr="ranges") | ast.Subscript(value=ast.Attribute(attr="ranges"), slice=ast.Slice()):
            return True
        case (
            ast.ListComp(elt=ast.Name(id=name), generators=loops)
            | ast.GeneratorExp(elt=ast.Name(id=name), generators=loops)
        ):
            return name in {_range_of(each) for each in loops}
        case ast.ListComp(elt=ast.Subscript(value=ast.Attribute(attr="ranges"))):
            return True
    return False


def _range_of(loop: ast.For | ast.comprehension) -> str:
    """Return the name that holds a single range in a loop over `scan.ranges`; empty if it is no such loop."""
    given, target = loop.iter, loop.target
    match given, target:
        case ast.Call(func=ast.Name(id="enumerate"), args=[given, *_]), ast.Tuple(elts=[_, target]):
            pass
    text = unparse(given).partition("[")[0]
    return target.id if isinstance(target, ast.Name) and text.endswith(".ranges") else ""


@suspicion_of(About.MEAN)
def means(tree: ast.AST) -> Words:
    """Find the mean, or the median, of ranges in a node that steers, in place of the nearest of them."""
    if "angular.z" not in unparse(tree):
        return
    for function in functions(tree):
        lists = _lists_of_ranges(function)
        for node in walk(function):
            of = ""
            if isinstance(node, ast.Call) and last_name(node.func) in MEANS and node.args:
                of = unparse(node.args[0])
            elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.Div):
                of = _summed(node)
            if of in lists or (of.endswith("]") and of.partition("[")[0].endswith(".ranges")):
                yield (
                    node,
                    f"{unparse(node)[:60]} depends on all that those rays see, near and far: the distance from a "
                    "wall is that of its nearest point, min(...)",
                )


def _summed(node: ast.BinOp) -> str:
    """Return `x` of `sum(x) / len(x)`; empty for anything else."""
    match node.left, node.right:
        case ast.Call(func=ast.Name(id="sum"), args=[one]), ast.Call(func=ast.Name(id="len"), args=[other]):
            return unparse(one) if unparse(one) == unparse(other) else ""
    return ""


@suspicion_of(About.ADDED, ast.FunctionDef)
def added_commands(function: ast.FunctionDef) -> Words:
    """Find a turning rate that is made by adding to the last one."""
    values = {unparse(target): value for target, value in assigned(function) if not isinstance(target, ast.Tuple)}
    for node in walk(function):
        if isinstance(node, ast.AugAssign) and isinstance(node.op, ast.Add | ast.Sub):
            old, new = unparse(node.target), node.value
        elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub):
            old, new = unparse(node.left), node.right
        else:
            continue
        if not old.startswith("self.") or isinstance(new, ast.Constant) or _depends(new, old, values, STEPS):
            continue  # a low-pass filter subtracts the last one, too
        kept = old.endswith("angular.z") or _becomes_turning(function, old)
        made = isinstance(node, ast.AugAssign) or _stored(function, node, old, values)
        if kept and made:
            yield (
                node,
                f"{unparse(node)[:60]} adds the correction to the last command, so it grows as long as the "
                "error lasts: a correction is the whole angular.z, computed for each scan alone",
            )


def _depends(node: ast.AST, name: str, values: dict[str, ast.expr], steps: int) -> bool:
    """Return whether an expression reads a name, also by way of other names."""
    texts = {unparse(each) for each in nodes_of(node, ast.Name, ast.Attribute)}
    if name in texts:
        return True
    return steps > 0 and any(_depends(values[text], name, values, steps - 1) for text in texts if text in values)


def _becomes_turning(function: Function, name: str) -> bool:
    """Return whether angular.z is assigned this very value, perhaps limited or with a sign."""
    return any(unparse(target).endswith("angular.z") and _bare(value, name) for target, value in assigned(function))


def _bare(node: ast.expr, name: str) -> bool:
    """Return whether an expression is a name, limited or with another sign, and not one term of a sum."""
    if unparse(node) == name:
        return True
    match node:
        case ast.UnaryOp(operand=inner):
            return _bare(inner, name)
        case ast.BinOp(op=ast.Mult(), left=ast.Name(id=factor), right=inner) if "gain" not in factor.lower():
            return factor in ("sign", "side", "s") and _bare(inner, name)
        case ast.Call(args=args):
            return any(_bare(each, name) for each in args)
    return False


def _stored(function: Function, node: ast.AST, old: str, values: dict[str, ast.expr]) -> bool:
    """Return whether a sum ends up where its first term was read."""
    for target, value in assigned(function):
        if unparse(target) == old:
            inside = any(each is node for each in walk(value))
            names = {unparse(each) for each in nodes_of(value, ast.Name)}
            if inside or any(values.get(name) is node for name in names):
                return True
    return False


@suspicion_of(About.INTEGRAL)
def integrals(tree: ast.AST) -> Words:
    """Find a sum of errors that a node that steers keeps from scan to scan."""
    if "angular.z" not in unparse(tree):
        return
    limited = {
        unparse(target)
        for target, value in assigned(tree)
        if isinstance(value, ast.Call | ast.IfExp) and unparse(target) in unparse(value)
    }
    for node in walk(tree):
        name, value = "", None
        if isinstance(node, ast.AugAssign) and isinstance(node.op, ast.Add):
            name, value = unparse(node.target), node.value
        elif isinstance(node, ast.Assign) and isinstance(node.value, ast.BinOp) and isinstance(node.value.op, ast.Add):
            name, value = unparse(node.targets[0]), node.value.right
            name = name if unparse(node.value.left) == name else ""
        kept = name.startswith("self.") and name not in limited and not isinstance(value, ast.Constant)
        if kept and ERROR.search(unparse(node)) and not HEADING.search(name):
            yield (
                node,
                f"{unparse(node)[:60]} is an integral that nothing limits: it grows while the robot is far "
                "away, and keeps it turning when it is near (wind-up); limit it, or leave it out",
            )


@suspicion_of(About.PARAMETER)
def kept_parameters(tree: ast.AST) -> Words:
    """Find a Parameter that __init__ keeps: other than its name says, it does not follow the node's parameter."""
    init = next((function for function in functions(tree) if function.name == "__init__"), None)
    for target, value in assigned(init) if init is not None else ():
        kept = unparse(target)
        if isinstance(value, ast.Call) and last_name(value.func) == "get_parameter" and kept.startswith("self."):
            yield (
                value,
                f"{kept} = {unparse(value)[:60]} keeps a Parameter, which is a copy: its .value does not change "
                "when the parameter is set",
            )


@suspicion_of(About.SETPOINT)
def added_setpoints(tree: ast.AST) -> Words:
    """Find a parameter that is added to a measured distance, where only the rest of the way could be meant."""
    given = set_to(tree)
    parameters, measured = (
        {name for name, values in given.items() if any(pattern.search(unparse(each)) for each in values)}
        for pattern in (PARAMETER, MEASURED)
    )
    for node in nodes_of(tree, ast.BinOp):
        if not isinstance(node.op, ast.Add):
            continue
        sides = [unparse(each) for each in (node.left, node.right)]
        for wanted, distance in (sides, sides[::-1]):
            if wanted in parameters and (MEASURED.search(distance) or distance in measured):
                said = f"{unparse(node)[:60]}: what is left to drive is the difference, {distance} - {wanted}"
                yield node, said
