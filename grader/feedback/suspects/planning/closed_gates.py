"""Suspects in planning that ends for ever: a flag or a state that nothing sets back closes the way to it."""

from __future__ import annotations

import ast
import re

from gz_course.grader.feedback.facts.syntax import Words, assigned, functions, nodes_of, unparse
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

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
