"""Suspects in ROS parameters whose new value does not reach what a node steers by: read once, not heard of, set back.

Each suspect is about `parameter NAME`: a check that has seen the old value at work names the one of that parameter.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.constants import named_numbers, number
from gz_course.grader.feedback.facts.ros_parameters import (
    ASKS,
    MODULE,
    declared,
    listeners,
    members,
    only_at_the_start,
    owners,
    reads,
)
from gz_course.grader.feedback.facts.syntax import assigned, calls, last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion
from gz_course.grader.feedback.suspects.about import About, Suspect

SLOW = 0.5  # [s] period of a timer that reads parameters too seldom
TYPES = {float: "DOUBLE", int: "INTEGER", str: "STRING", bool: "BOOL"}
TYPE = frozenset({*TYPES.values(), "DOUBLE_ARRAY", "INTEGER_ARRAY", "STRING_ARRAY", "BYTE_ARRAY"})


@suspicion
def stale(tree: ast.Module) -> Iterator[Suspect]:
    """Find, for each parameter that is declared, why a new value would not be used."""
    text, known = unparse(tree), declared(tree)
    if not known or "angular.z" not in text or "LaserScan" not in text or "/parameter_events" in text:
        return
    inside, start, heard = owners(tree), only_at_the_start(tree), listeners(tree)
    found = list(reads(tree))
    unnamed = [call for call, name in found if not name]  # which may read any of them
    if unnamed:
        if not heard and all(inside[id(call)] in start - {MODULE} for call, _ in found):
            once = f"{unparse(unnamed[0])[:60]} is read only once, in {inside[id(unnamed[0])]}"
            words = f"{once}; read parameters in each callback of a scan"
            yield from ((unnamed[0].lineno, About.PARAMETER.of(name), words) for name in known)
        return
    for name, (line, default) in known.items():
        where = [(call, inside[id(call)]) for call, other in found if other == name]
        later = [call for call, function in where if function not in start]
        said = (
            _sets_back(tree, name, inside, start)
            or next(filter(None, (_not_heard(tree, each, name, default) for each in heard if not later)), None)
            or _only_while_none(tree, later)
            or _kept(tree, name, inside, start)
        )
        if said is None and not heard and not later:
            said = _once(where, name, line, inside)
        if said is not None:
            yield said[0], About.PARAMETER.of(name), said[1]
        elif not heard and (slow := _seldom(tree, [(call, function) for call, function in where if call in later])):
            yield slow[0], About.SELDOM.of(name), slow[1]


def _seldom(tree: ast.Module, later: list[tuple[ast.Call, str]]) -> tuple[int, str] | None:
    """Find a parameter that nothing but a slow timer reads again."""
    known, slow = named_numbers(tree), dict[str, float]()
    for call, name in calls(tree):
        given = {each.arg: each.value for each in call.keywords}
        period = call.args[0] if call.args else given.get("timer_period_sec")
        fired = call.args[1] if len(call.args) > 1 else given.get("callback")
        if name == "create_timer" and period is not None and fired is not None:
            slow[last_name(fired)] = number(period, known) or 0.0
    if not later or any(slow.get(function, 0.0) < SLOW for _, function in later):
        return None
    call, function = later[0]
    return call.lineno, (
        f"{unparse(call)[:60]} is read every {slow[function]:g} s only, by a timer, so a new value takes effect "
        "late; read it in each callback of a scan"
    )


def _once(where: list[tuple[ast.Call, str]], name: str, line: int, inside: dict[int, str]) -> tuple[int, str]:
    if where:
        call, function = where[0]
        place = "when the file is loaded" if function == MODULE else f"in {function}"
        return call.lineno, f"{unparse(call)[:60]} is read only once, {place}; read it in each callback of a scan"
    return line, (
        f"the parameter {name} is declared here, and nothing reads it later: read it in each callback of a scan, "
        f"self.get_parameter({name!r}).value"
    )


def _kept(tree: ast.Module, name: str, inside: dict[int, str], start: set[str]) -> tuple[int, str] | None:
    """Find an attribute that keeps the first value of a parameter for good, or one that keeps it and is never read."""
    stores: dict[str, list[tuple[ast.expr, ast.expr]]] = {}
    for target, value in assigned(tree):
        stores.setdefault(unparse(target), []).append((target, value))
    loads = {
        unparse(node): inside[id(node)]
        for node in nodes_of(tree, ast.Attribute)
        if isinstance(node.ctx, ast.Load) and inside[id(node)] not in start
    }
    for kept, given in stores.items():
        of = [value for _, value in given if _is_value_of(value, name)]
        if not kept.startswith("self.") or not of:
            continue
        once = all(inside[id(target)] in start for target, _ in given)
        if once and kept in loads:
            return of[0].lineno, (
                f"{kept} = {unparse(of[0])[:60]} is read only once, in {inside[id(of[0])]}, and {loads[kept]}() "
                "keeps that value; read the parameter there"
            )
        if kept not in loads and not once:
            return of[0].lineno, f"{kept} keeps the parameter {name}, and nothing reads {kept} later"
    return None


def _is_value_of(value: ast.expr, name: str) -> bool:
    """Return whether an expression is the value of a parameter that is read, or declared, in it."""
    match value:
        case ast.Attribute(value=ast.Call(args=[ast.Constant(value=found), *_]) as call, attr="value"):
            return found == name and last_name(call.func) in ASKS | {"declare_parameter"}
        case ast.Call(args=[ast.Constant(value=found)]):
            return found == name
    return False


def _sets_back(tree: ast.AST, name: str, inside: dict[int, str], start: set[str]) -> tuple[int, str] | None:
    """Find a node that sets its own parameter again and again."""
    for call, what in calls(tree):
        if what not in ("set_parameters", "set_parameters_atomically") or inside[id(call)] in start:
            continue
        if any(isinstance(each, ast.Constant) and each.value == name for each in walk(call)):
            return call.lineno, (
                f"{unparse(call)[:70]} sets {name} back in each {inside[id(call)]}(): whatever somebody else has "
                "set is lost"
            )
    return None


def _not_heard(
    tree: ast.Module, function: ast.FunctionDef, name: str, default: ast.expr | None
) -> tuple[int, str] | None:
    """Find a callback for changes that passes over a parameter."""
    single = members(function)
    asked: set[str] = set()
    for node in nodes_of(function, ast.Compare):
        if last_name(node.left) == "name":
            asked |= {str(each.value) for each in nodes_of(node.comparators[0], ast.Constant)}
    code = unparse(function)
    if asked and name not in asked and name not in code and "else" not in code and single:
        shown = ", ".join(sorted(asked))
        return function.lineno, f"{function.name}() asks for {shown} alone, so a new {name} is passed over"
    for test in nodes_of(function, ast.If):
        if any(isinstance(each, ast.Constant) and each.value == name for each in walk(test.test)):
            for target, value in assigned(ast.Module(test.body, [])):
                kept = unparse(target)
                if kept.startswith("self.") and unparse(value).endswith(".value") and not _is_read(tree, kept):
                    return value.lineno, f"{kept} keeps the new value of {name}, and nothing reads {kept} later"
    kind = TYPES.get(type(default.value)) if isinstance(default, ast.Constant) else None
    for test in nodes_of(function, ast.If):
        about = {str(each.value) for each in nodes_of(test.test, ast.Constant)}
        types = {last_name(each) for each in walk(test.test)} & TYPE
        if kind and name in about and types and kind not in types:
            return test.lineno, (
                f"{unparse(test.test)[:80]} asks for the type {', '.join(sorted(types))}, and {name} is declared "
                f"as a {kind}, so its new value is passed over"
            )
    return None


def _is_read(tree: ast.AST, kept: str) -> bool:
    """Return whether an attribute of self is read anywhere, also under the name of another object."""
    attribute = kept.rpartition(".")[2]
    return any(
        isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Load) and node.attr == attribute
        for node in walk(tree)
    )


def _only_while_none(tree: ast.AST, later: list[ast.Call]) -> tuple[int, str] | None:
    """Find a parameter that is read in a callback, but only while something is still None, or not yet done."""
    if not later:
        return None
    found: tuple[int, str] | None = None
    guarded: set[int] = set()
    for test in nodes_of(tree, ast.If):
        asked = _guard(test.test)
        if not asked:
            continue
        body = [each for statement in test.body for each in walk(statement)]
        sets = any(
            isinstance(each, ast.Assign)
            and asked in [unparse(one) for target in each.targets for one in _parts(target)]
            for each in body
        )
        there = [call for call in later if any(each is call for each in body)]
        if sets and there:
            guarded |= {id(call) for call in there}
            found = found or (
                there[0].lineno,
                f"{unparse(there[0])[:60]} is read only once, in the block of  if {unparse(test.test)[:60]}: "
                "read it each time",
            )
    return found if found and guarded >= {id(call) for call in later} else None


def _parts(target: ast.expr) -> list[ast.expr]:
    return list(target.elts) if isinstance(target, ast.Tuple) else [target]


def _guard(test: ast.expr) -> str:
    """Return the attribute of `self.x is None`, `not self.x` and `self.first`; empty for another test."""
    if isinstance(test, ast.Compare) and isinstance(test.ops[0], ast.Is) and unparse(test.comparators[0]) == "None":
        test = test.left
    elif isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not):
        test = test.operand
    text = unparse(test)
    return text if isinstance(test, ast.Attribute) and text.startswith("self.") else ""
