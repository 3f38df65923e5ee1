"""Names that do not reach what they should: local variables for attributes, replaced methods, other orders."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import (
    Place,
    assignments,
    functions,
    kept,
    last_name,
    nodes_of,
    unparse,
    walk,
)
from gz_course.grader.feedback.slips import slip

BEFORE = ("durations",)

Function = ast.FunctionDef | ast.AsyncFunctionDef
EITHER = {"start", "goal", "end", "first", "second", "source", "target", "here", "there"}  # in both orders on purpose
SYMMETRIC = re.compile(r"dist|between|near|close|same|apart|away|gap|length|swap|way|path|route|touch")


def _classes(tree: ast.AST) -> tuple[ast.ClassDef, ...]:
    return nodes_of(tree, ast.ClassDef)


def _methods(owner: ast.ClassDef) -> list[Function]:
    return [node for node in owner.body if isinstance(node, Function)]


def _attributes(node: ast.AST, context: type[ast.expr_context]) -> dict[str, int]:
    """Return the attributes of self that are read or set within a node, with the line of the first."""
    found: dict[str, int] = {}
    for each in nodes_of(node, ast.Attribute):
        if isinstance(each.ctx, context) and unparse(each.value) == "self":
            found.setdefault(each.attr, each.lineno)
    return found


@slip
def local_for_global(tree: ast.AST) -> Iterator[Place]:
    """Find `busy = True` in a function without `global busy`: it is never read there, the variable of the module is."""
    if not isinstance(tree, ast.Module):
        return
    module = {
        target.id
        for statement in tree.body
        if isinstance(statement, ast.Assign)
        for target in statement.targets
        if isinstance(target, ast.Name)
    }
    every = [node for node in walk(tree) if isinstance(node, Function)]
    reads: dict[str, int] = {}
    for function in every:
        names = [node for node in nodes_of(function, ast.Name)]
        own = {node.id for node in names if isinstance(node.ctx, ast.Store)} - _declared(function)
        for node in names:
            if isinstance(node.ctx, ast.Load) and node.id in module - own - _arguments(function):
                reads.setdefault(node.id, node.lineno)
    for function in every:
        names = [node for node in nodes_of(function, ast.Name)]
        loaded = {node.id for node in names if isinstance(node.ctx, ast.Load)}
        for target, statement in assignments(function):
            name = target.id if isinstance(target, ast.Name) else ""
            if name in reads and name not in loaded | _declared(function) | _arguments(function):
                yield (
                    statement.lineno,
                    f"{name} = ... makes a variable of {function.name} alone, and line {reads[name]} reads the one of "
                    f"the module: write `global {name}` first in {function.name}",
                )


def _never_changed(owner: ast.ClassDef) -> set[str]:
    """Return the attributes that are set to None, True or False once, in `__init__`, and to nothing else anywhere."""
    found: dict[str, list[str]] = {}
    for node in walk(owner):
        for target in node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]:
            for each in walk(target) if isinstance(target, ast.expr) else ():
                if isinstance(each, ast.Attribute) and unparse(each.value) == "self":
                    value = unparse(node.value) if isinstance(node, ast.Assign) else ""
                    found.setdefault(each.attr, []).append(value)
    flags = {name for name, values in found.items() if values in (["True"], ["False"])}
    return flags | {name for name, values in found.items() if set(values) == {"None"}}


@slip
def one_name_for_two_timers(tree: ast.AST) -> Iterator[Place]:
    """Find two timers that are given the same name, of which cancel() then ends the second one only."""
    for owner in _classes(tree):
        cancelled = {unparse(node.value) for node in nodes_of(owner, ast.Attribute) if node.attr in ("cancel", "reset")}
        for method in _methods(owner):
            made: dict[str, int] = {}
            for statement in method.body:
                if not isinstance(statement, ast.Assign) or "create_timer" not in unparse(statement.value):
                    continue
                name = unparse(statement.targets[0])
                if name in made and name in cancelled:
                    yield (
                        statement.lineno,
                        f"{name} names this timer now, and no more that of line {made[name]}: {name}.cancel() does not "
                        "end the first one; give each timer a name of its own",
                    )
                made[name] = statement.lineno


@slip
def local_for_attribute(tree: ast.AST) -> Iterator[Place]:
    """Find `done = True` where `self.done` was meant: the local variable is never read, the attribute is."""
    for owner in _classes(tree):
        read, never_set = _attributes(owner, ast.Load), _never_changed(owner)
        for method in _methods(owner):
            kept = {name for node in nodes_of(method, ast.Global, ast.Nonlocal) for name in node.names}
            names = [node for node in nodes_of(method, ast.Name)]
            loaded = {node.id for node in names if isinstance(node.ctx, ast.Load)} | kept
            for target, node in assignments(method):
                if not isinstance(target, ast.Name) or target.id not in read:
                    continue
                lost = target.id in never_set - kept and f"self.{target.id}" not in unparse(node.value)
                if target.id in loaded and not lost:
                    continue
                yield (
                    node.lineno,
                    f"{target.id} = ... makes a variable of {method.name} alone; line "
                    f"{read[target.id]} reads self.{target.id}, so write self.{target.id} = ...",
                )


@slip
def hidden_methods(tree: ast.AST) -> Iterator[Place]:
    """Find an attribute with the name of a method of the same class, which is then no method any more."""
    for owner in _classes(tree):
        methods = {method.name: method.lineno for method in _methods(owner) if not method.decorator_list}
        for node in nodes_of(owner, ast.Assign):
            for target in node.targets:
                name = unparse(target).removeprefix("self.")
                own = unparse(target) == f"self.{name}"
                if own and name in methods and f"self.{name}" not in unparse(node.value):
                    yield (
                        node.lineno,
                        f"self.{name} = ... hides the method {name} of line {methods[name]}: self.{name} is then this "
                        "value; give one of the two another name",
                    )


@slip
def defined_twice(tree: ast.AST) -> Iterator[Place]:
    for owner in _classes(tree):
        seen: dict[str, int] = {}
        for method in _methods(owner):
            if method.name in seen and not method.decorator_list:
                yield (
                    method.lineno,
                    f"this def {method.name} replaces that in line {seen[method.name]}: a class has one method of a "
                    f"name",
                )
            seen[method.name] = method.lineno


@slip
def attribute_of_the_class(tree: ast.AST) -> Iterator[Place]:
    """Find a counter or flag that is set on the class and read on the object, or the other way round."""
    for owner in _classes(tree):
        objects = _attributes(owner, ast.Store)
        sums = [node.target for node in nodes_of(owner, ast.AugAssign)]
        for target in [*sums, *(target for target, _ in assignments(owner))]:
            if isinstance(target, ast.Attribute) and unparse(target.value) == owner.name and target.attr in objects:
                yield (
                    target.lineno,
                    f"{unparse(target)} is a variable of the class; self.{target.attr}, set in line "
                    f"{objects[target.attr]}, is another one",
                )


def _declared(function: Function) -> set[str]:
    return {
        name for node in nodes_of(function, ast.Global, ast.Nonlocal) for name in node.names
    }  # fmt: skip


def _arguments(function: Function) -> set[str]:
    return {each.arg for each in nodes_of(function, ast.arg)}


@slip
def exchanged_names(tree: ast.AST) -> Iterator[Place]:
    """Find `drive(turn, speed)` where the file has `def drive(speed, turn)` and no call in the right order."""
    for function, given in calls_of_own(tree):
        params = parameters(function)
        if SYMMETRIC.search(function.name.lower()):
            continue
        for i, first in enumerate(params):
            for k, second in enumerate(params[i + 1 :], i + 1):
                pairs = [(last_name(call.args[i]), last_name(call.args[k])) for call in given if len(call.args) > k]
                if (
                    EITHER & {first, second}
                    or _letters(first, second)
                    or (first, second) in pairs
                    or (second, first) not in pairs
                ):
                    continue
                call = next(
                    call
                    for call in given
                    if len(call.args) > k and (last_name(call.args[i]), last_name(call.args[k])) == (second, first)
                )
                order = ", ".join(params)
                yield (
                    call.lineno,
                    f"{unparse(call)[:60]} has {second} and {first} in the wrong order: the function, in line "
                    f"{function.lineno}, is {function.name}({order})",
                )


def _letters(first: str, second: str) -> bool:
    """Say whether the names of two parameters are single letters that mean nothing, such as a and b."""
    return len(first) == len(second) == 1 and {first, second} != {"x", "y"}


@kept
def calls_of_own(tree: ast.AST) -> tuple[tuple[ast.FunctionDef, list[ast.Call]], ...]:
    """Return each function whose name is defined once, with the calls of it from other functions."""
    defined = list(functions(tree))
    names = [function.name for function in defined]
    found: list[tuple[ast.FunctionDef, list[ast.Call]]] = []
    for function in defined:
        own = {id(node) for node in walk(function)}
        if names.count(function.name) != 1 or any(
            isinstance(node, ast.Call) and last_name(node.func) == function.name for node in walk(function)
        ):
            continue
        method = is_method(function)
        given = [
            node
            for node in nodes_of(tree, ast.Call)
            if id(node) not in own
            and last_name(node.func) == function.name
            and isinstance(node.func, ast.Attribute) == method
            and not any(isinstance(each, ast.Starred) for each in node.args)
        ]
        found.append((function, given))
    return tuple(found)


def is_method(function: ast.FunctionDef) -> bool:
    """Say whether the first parameter is self, or the function a static method."""
    static = any(last_name(each) == "staticmethod" for each in function.decorator_list)
    return static or (bool(function.args.args) and function.args.args[0].arg == "self")


def parameters(function: ast.FunctionDef) -> list[str]:
    """Return the names of the parameters that a call gives in order, without self."""
    names = [each.arg for each in [*function.args.posonlyargs, *function.args.args]]
    return names[1:] if names[:1] == ["self"] else names
