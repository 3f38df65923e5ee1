"""What is read and never set: keys of a dictionary, attributes that stay None, previous values that stay the first."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Place, calls, functions, is_none, last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.slips import slip

EMPTY = ("{}", "dict()")
ASKS = ("get", "pop")
Function = ast.FunctionDef | ast.AsyncFunctionDef
LEAVES = ast.Return | ast.Continue | ast.Raise
PREVIOUS = re.compile(r"(^|_)(last|prev|previous|old|before)(_|$)")


@slip
def keys_that_nothing_sets(tree: ast.AST) -> Iterator[Place]:
    """Find `self.poses["me"]` in a file that begins with an empty dictionary, and never sets this key."""
    for name in _begun_empty(tree):
        stored = _stored(tree, name)
        if not stored or any(key is None for key, _ in stored):
            continue
        keys = {str(key) for key, _ in stored}
        for node in walk(tree):
            key = _read(node, name)
            if key is not None and key not in keys:
                lines = ", ".join(str(line) for line in sorted({line for _, line in stored})[:3])
                yield (
                    node.lineno,  # type: ignore[attr-defined]
                    f"nothing sets {name}[{key!r}]: what is set is {', '.join(map(repr, sorted(keys)))} (line {lines})",
                )
                break


def _begun_empty(tree: ast.AST) -> list[str]:
    """Return the dictionaries of the node that are empty at first, and are used by their keys alone."""
    made: dict[str, list[str]] = {}
    for node in nodes_of(tree, ast.Assign, ast.AnnAssign):
        if node.value is not None:
            for target in node.targets if isinstance(node, ast.Assign) else [node.target]:
                if isinstance(target, ast.Attribute):
                    made.setdefault(unparse(target), []).append(unparse(node.value))
    return [name for name, values in made.items() if set(values) <= set(EMPTY) and _by_keys_alone(tree, name)]


def _by_keys_alone(tree: ast.AST, name: str) -> bool:
    """Return whether a dictionary is handed to nobody, and no method of it sets keys."""
    known = {id(node.value) for node in nodes_of(tree, ast.Subscript, ast.Attribute)}
    known |= {id(target) for node in nodes_of(tree, ast.Assign) for target in node.targets}
    known |= {id(node.target) for node in nodes_of(tree, ast.AnnAssign)}
    known |= {id(each) for node in nodes_of(tree, ast.Compare) for each in node.comparators}
    known |= {id(each) for call, called in calls(tree) if called == "len" for each in call.args}
    for node in walk(tree):
        if isinstance(node, ast.Attribute) and unparse(node) == name and id(node) not in known:
            return False
        if isinstance(node, ast.Attribute) and node.attr == "update" and unparse(node.value) == name:
            return False
    return True


def _stored(tree: ast.AST, name: str) -> list[tuple[str | None, int]]:
    """Return the keys that are set, with the lines that give them; None for one that is not known."""
    found: list[tuple[str | None, int]] = []
    for function in functions(tree):
        parameters = [each.arg for each in function.args.args]
        for node in walk(function):
            key = None
            if isinstance(node, ast.Subscript) and isinstance(node.ctx, ast.Store) and unparse(node.value) == name:
                key = node.slice
            elif isinstance(node, ast.Call) and unparse(node.func) == f"{name}.setdefault" and node.args:
                key = node.args[0]
            if isinstance(key, ast.Name) and key.id in parameters:
                found += _handed(tree, function, parameters.index(key.id), key.id)
            elif key is not None:
                known = isinstance(key, ast.Constant) and isinstance(key.value, str)
                found.append((key.value if known else None, node.lineno))  # type: ignore[attr-defined]
    return found


def _handed(tree: ast.AST, function: ast.FunctionDef, place: int, name: str) -> list[tuple[str | None, int]]:
    """Return the texts that a function of the file is given for one of its parameters."""
    bound = bool(function.args.args) and function.args.args[0].arg == "self"
    found: list[tuple[str | None, int]] = []
    seen = 0
    for call, called in calls(tree):
        given: list[ast.expr] | None = None
        if called == function.name:
            given = call.args[place - bound :][:1]
        elif called == "partial" and call.args and last_name(call.args[0]) == function.name:
            given = call.args[1 + place - bound :][:1]
        if given is None:
            continue
        seen += 1
        given = given or [each.value for each in call.keywords if each.arg == name]
        value = given[0] if given else None
        known = isinstance(value, ast.Constant) and isinstance(value.value, str)
        found.append((value.value if known else None, call.lineno))  # type: ignore[union-attr]
    named = sum(1 for node in walk(tree) if last_name(node) == function.name)
    return found if seen and named == seen else [(None, function.lineno)]


def _read(node: ast.AST, name: str) -> str | None:
    """Return the text by which a dictionary is read; None if a node is something else."""
    match node:
        case ast.Subscript(value=owner, slice=ast.Constant(value=str() as key), ctx=ast.Load()):
            return key if unparse(owner) == name else None
        case ast.Call(func=ast.Attribute(value=owner, attr=method), args=[ast.Constant(value=str() as key), *_]):
            return key if method in ASKS and unparse(owner) == name else None
    return None


@slip
def waits_for_ever(tree: ast.AST) -> Iterator[Place]:
    """Find `if self.x is None: return` where nothing in the file sets `x` to anything else than None."""
    only_none, set_in = _values(tree)
    if any(isinstance(each, ast.Name) and each.id in ("setattr", "vars") for each in walk(tree)):
        return
    for function in _functions(tree):
        for test in (each for each in function.body if isinstance(each, ast.If)):
            if not isinstance(test.body[-1], LEAVES):
                continue
            for name in _asked_for_none(test.test):
                if name in only_none and function.name != "__init__":
                    yield (
                        test.lineno,
                        f"self.{name} is None for ever, so nothing below this line ever runs: no line sets self.{name} "
                        f"to anything else{_twice(set_in)}",
                    )


def _functions(tree: ast.AST) -> list[Function]:
    return [each for each in walk(tree) if isinstance(each, Function)]


def _values(tree: ast.AST) -> tuple[set[str], dict[str, list[str]]]:
    """Return the attributes that are only set to None, and the functions that set each other attribute."""
    none: dict[str, bool] = {}
    set_in: dict[str, list[str]] = {}
    for function in _functions(tree):
        for node in nodes_of(function, ast.Attribute):
            if not isinstance(node.ctx, ast.Store):
                continue
            made = next((each for each in walk(function) if _makes(each, node)), None)
            value = getattr(made, "value", None)
            nothing = isinstance(made, ast.Assign | ast.AnnAssign) and value is not None and is_none(value)
            none[node.attr] = none.get(node.attr, True) and nothing and function.name == "__init__"
            if function.name != "__init__":
                set_in.setdefault(node.attr, []).append(function.name)
    own = {id(each) for function in _functions(tree) for each in walk(function)}
    for node in nodes_of(tree, ast.Attribute):
        if isinstance(node.ctx, ast.Store):
            inside = id(node) in own and isinstance(node.value, ast.Name) and node.value.id == "self"
            none[node.attr] = none.get(node.attr, True) and inside
    return {name for name, only in none.items() if only}, set_in


def _makes(statement: ast.AST, target: ast.Attribute) -> bool:
    targets = statement.targets if isinstance(statement, ast.Assign) else [getattr(statement, "target", None)]
    return isinstance(statement, ast.Assign | ast.AnnAssign) and target in targets


def _asked_for_none(test: ast.expr) -> Iterator[str]:
    """Yield the attributes of self of which one that is None makes a condition true."""
    if isinstance(test, ast.BoolOp) and isinstance(test.op, ast.Or):
        for each in test.values:
            yield from _asked_for_none(each)
    elif isinstance(test, ast.Compare) and isinstance(test.ops[0], ast.Is) and is_none(test.comparators[0]):
        yield from _own(test.left)
    elif isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not):
        yield from _own(test.operand)


def _own(node: ast.expr) -> Iterator[str]:
    if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "self":
        yield node.attr


def _twice(set_in: dict[str, list[str]]) -> str:
    """Return that two functions set the same attribute, as a copied callback does; else nothing."""
    for name, names in set_in.items():
        if len(set(names)) == 2 and len(names) == 2:
            return f"; {names[0]} and {names[1]} both set self.{name}"
    return ""


@slip
def previous_stays(tree: ast.AST) -> Iterator[Place]:
    """Find `error - self.last_error` where nothing but `__init__` sets `last_error`, and it sets it to a number."""
    if any(isinstance(each, ast.Name) and each.id in ("setattr", "vars") for each in walk(tree)):
        return
    set_in: dict[str, list[str]] = {}
    first: dict[str, ast.expr] = {}
    for function in _functions(tree):
        for node in walk(function):
            if isinstance(node, ast.Attribute) and not isinstance(node.ctx, ast.Load):
                set_in.setdefault(node.attr, []).append(function.name)
            if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Attribute):
                first[node.targets[0].attr] = node.value
    for function in _functions(tree):
        for node in nodes_of(function, ast.BinOp):
            if not isinstance(node.op, ast.Sub) or function.name == "__init__":
                continue
            for name in _own(node.right):
                value = first.get(name)
                number = isinstance(value, ast.Constant) and type(value.value) in (int, float)
                if number and PREVIOUS.search(name) and set_in.get(name) == ["__init__"]:
                    yield (
                        node.lineno,
                        f"self.{name} stays {unparse(first[name])}, because only __init__ sets it, so "
                        f"{unparse(node)[:60]} is no change: set it to the new value at the end of each call",
                    )
