"""Suspects in flags and states that nothing sets back: they steer, stop or close the way to planning for ever."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Words, assigned, called, functions, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

BEFORE = ("endless_drives", "callbacks")

EMPTY = re.compile(r"^not |\bis None\b|^len\(.*\) (?:== 0|< 1)$|== \[\]$")


@suspicion_of(About.FLAG)
def finished_for_ever(tree: ast.AST) -> Words:
    """Find a flag that is set where a search has found nothing, and that no line ever sets back."""
    for name, places in _flags(tree).items() if "OccupancyGrid" in unparse(tree) else ():
        if not _guards(tree, name):
            continue
        for function in functions(tree):
            for node in nodes_of(function, ast.If):
                place = next((each for each in node.body if each.lineno in places), None)
                test = unparse(node.test)
                if place is not None and EMPTY.search(test) and name not in test and ".scan" not in test:
                    yield (
                        place,
                        f"{unparse(place)[:40]} is set as soon as `{test[:40]}` holds, and nothing sets it back: "
                        "if that is so at the first call, before a scan has come, the robot never drives; wait for a "
                        "scan before you search, and search again later",
                    )


@suspicion_of(About.WAY)
def planned_once(tree: ast.AST) -> Words:
    """Find a function that returns at once after its first call, by a flag or by a state that only it changes."""
    flags = _flags(tree)
    states: dict[str, list[tuple[str, str]]] = {}
    for function in functions(tree):
        for target, value in assigned(function):
            states.setdefault(unparse(target), []).append((function.name, unparse(value)))
    for function in functions(tree):
        if function.name == "__init__" or not any(isinstance(each, ast.While | ast.For) for each in function.body):
            continue
        for node in (each for each in function.body if isinstance(each, ast.If)):
            if not isinstance(node.body[-1], ast.Return) or len(node.body) > 1:
                continue
            for test in node.test.values if isinstance(node.test, ast.BoolOp) else [node.test]:
                name = unparse(test)
                own = [each for each in function.body if each.lineno in flags.get(name, ())]
                if own:
                    yield node, _once(function.name, unparse(own[0]))
                match test:
                    case ast.Compare(left=left, ops=[ast.NotEq()], comparators=[ast.Constant(value=str()) as asked]):
                        given = states.get(unparse(left), [])
                        begun = {where for where, text in given if text == unparse(asked)}
                        other = [text for where, text in given if where == function.name and text != unparse(asked)]
                        if begun == {"__init__"} and other:
                            yield node, _once(function.name, f"{unparse(left)} = {other[-1]}")


@suspicion_of(About.WAY, ast.FunctionDef)
def kept_way(function: ast.FunctionDef, tree: ast.AST) -> Words:
    """Find a function that returns while there is a way, and alone sets it: nothing takes the way away again."""
    for node in (each for each in function.body if isinstance(each, ast.If)):
        match node.test:
            case ast.Attribute() as way if isinstance(node.body[-1], ast.Return) and len(node.body) == 1:
                name = unparse(way)
            case _:
                continue
        changed = any(
            part in unparse(other)
            for other in functions(tree)
            if other.name != "__init__"
            for part in (f"{name}.pop", f"{name}.clear", f"{name}.remove", f"del {name}", f"{name} = []")
        )
        makers = {other.name for other in functions(tree) if any(unparse(one) == name for one, _ in assigned(other))}
        read = any(f"in {name}:" in unparse(each) or f"{name}[" in unparse(each) for each in functions(tree))
        if read and not changed and function.name in makers <= {function.name, "__init__"}:
            yield (
                node,
                f"{function.name} returns while `{name}` holds anything, and nothing empties it: the first way is "
                "kept for ever, also when the robot is at its end. Take out the cells that are reached, or plan "
                "again each time",
            )


def _once(name: str, line: str) -> str:
    return (
        f"{name} returns here for ever once it has set `{line}`, which nothing sets back: a way is planned only once, "
        "with what was seen until then"
    )


def _flags(tree: ast.AST) -> dict[str, set[int]]:
    """Return the attributes that are False in `__init__` and only ever True elsewhere, with the lines that set them."""
    begun, places, others = set(), dict[str, set[int]](), set()
    for function in functions(tree):
        for target, value in assigned(function):
            name = unparse(target)
            if not name.startswith("self."):
                continue
            constant = value.value if isinstance(value, ast.Constant) else None
            if function.name == "__init__" and constant is False:
                begun.add(name)
            elif function.name != "__init__" and constant is True:
                places.setdefault(name, set()).add(target.lineno)
            else:
                others.add(name)
    return {name: lines for name, lines in places.items() if name in begun - others}


def _guards(tree: ast.AST, name: str) -> bool:
    """Return whether a function does nothing, or leaves out most of what it does, once a flag is set."""
    for node in nodes_of(tree, ast.If):
        parts = [unparse(each) for each in ([*node.test.values] if isinstance(node.test, ast.BoolOp) else [node.test])]
        if (name in parts and any(isinstance(each, ast.Return) for each in node.body)) or f"not {name}" in parts:
            return True
    return False


@suspicion_of(About.FLAG_FOR_EVER)
def for_ever(tree: ast.Module) -> Words:
    """Find a flag that chooses angular.z, is set to True in a callback of scans, and never to False again."""
    if ".ranges" not in unparse(tree):
        return
    given: dict[str, list[tuple[str, ast.expr, ast.expr]]] = {}
    for function in functions(tree):
        for target, value in assigned(function):
            given.setdefault(unparse(target), []).append((function.name, target, value))
    asked = {unparse(each) for test in _choosing(tree) for each in walk(test)}
    for name, values in given.items():
        later = [(target, value) for function, target, value in values if function != "__init__"]
        ever = bool(later) and all(isinstance(value, ast.Constant) and value.value is True for _, value in later)
        if name.startswith("self.") and name in asked and ever and len(values) > len(later):
            yield later[0][0], f"{name} = True stays so for ever: set it back to False when what it is for is over"


def _choosing(tree: ast.AST) -> Iterator[ast.expr]:
    """Yield the conditions on which a value of angular.z depends."""
    for node in walk(tree):
        if isinstance(node, ast.IfExp) or (isinstance(node, ast.If) and _sets_the_rate(node)):
            yield node.test


def _sets_the_rate(node: ast.If) -> bool:
    return any(unparse(target).endswith("angular.z") for target, _ in assigned(node))


@suspicion_of(About.STOPPED)
def stops_for_ever(tree: ast.AST) -> Words:
    """Find `self.arrived = True` that nothing sets back, where `if self.arrived` returns or sends no speed."""
    if "ActionServer" in called(tree):
        return  # a goal that is done stays done
    given: dict[str, list[tuple[str, ast.expr]]] = {}
    for function in functions(tree):
        for target, value in assigned(function):
            if (name := unparse(target)).startswith("self."):
                given.setdefault(name, []).append((function.name, value))
    for name, values in given.items():
        begun = [value for where, value in values if where == "__init__"]
        later = [value for where, value in values if where != "__init__"]
        if not begun or not later or not all(_is(value, False) for value in begun):
            continue
        if all(_is(value, True) for value in later) and (stop := _stop(tree, name)):
            yield (
                later[0],
                f"{name} becomes True here, and nothing sets it back to False: from then on line {stop} keeps the "
                "robot where it is, however far it is behind",
            )


def _is(value: ast.expr, wanted: bool) -> bool:
    return isinstance(value, ast.Constant) and value.value is wanted


def _stop(tree: ast.AST, name: str) -> int:
    """Return the line in which a flag that is set lets a function return, or sets a speed of zero; 0 if none does."""
    driving = (f for f in functions(tree) if any(unparse(t).endswith("linear.x") for t, _ in assigned(f)))
    for node in (each for function in driving for each in walk(function)):
        if isinstance(node, ast.IfExp) and unparse(node.test) == name and _zero(node.body):
            return node.lineno
        if not isinstance(node, ast.If) or not _asks(node.test, name):
            continue
        returns = any(isinstance(each, ast.Return) for each in node.body)
        speeds = [
            value for part in node.body for target, value in assigned(part) if unparse(target).endswith("linear.x")
        ]
        empty = returns and not speeds and ("publish" not in called(node) or "Twist()" in unparse(node))
        if empty or (speeds and all(_zero(each) for each in speeds)):
            return node.lineno
    return 0


def _asks(test: ast.expr, name: str) -> bool:
    """Return whether a condition holds as soon as a flag is set."""
    if isinstance(test, ast.BoolOp) and isinstance(test.op, ast.Or):
        return any(_asks(each, name) for each in test.values)
    return unparse(test) in (name, f"{name} is True", f"{name} == True")


def _zero(value: ast.expr) -> bool:
    return isinstance(value, ast.Constant) and value.value == 0 and value.value is not False
