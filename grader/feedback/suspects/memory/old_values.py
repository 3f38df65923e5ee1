"""Suspects in what is read once and taken for the present: a copy, a first message, the oldest, every tenth."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.constants import named_numbers, number
from gz_course.grader.feedback.facts.syntax import Words, assigned, called, calls, functions, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

FEWEST = 2
# Parts of names that keep a first value on purpose.
FIRST = ("start", "first", "begin", "origin", "home", "init", "zero", "ref", "from", "old", "last", "prev")
MOST = 3  # copies that are named
WAITS = frozenset({"publish", "publish_feedback", "sleep", "spin_once"})  # of a loop during which callbacks run
ADDS = frozenset({"append", "appendleft"})


@suspicion_of(About.ALIAS, ast.FunctionDef)
def aliases(function: ast.FunctionDef) -> Words:
    """Find `grid = self.map` followed by `grid[...] = ...` in a function that publishes no map."""
    for node in nodes_of(function, ast.Assign):
        if len(node.targets) != 1:
            continue
        target, value = node.targets[0], node.value
        if isinstance(target, ast.Name) and isinstance(value, ast.Attribute) and _own(value):
            for changed in _changes(function, target.id, node.lineno):
                yield (
                    changed,
                    f"{unparse(changed)[:70]} changes {unparse(value)} itself, because {target.id} = "
                    f"{unparse(value)} in line {node.lineno} makes no copy: {unparse(value)}.copy()",
                )


def _own(value: ast.Attribute) -> bool:
    return isinstance(value.value, ast.Name) and value.value.id == "self"


def _changes(function: ast.FunctionDef, name: str, line: int) -> Iterator[ast.stmt]:
    """Yield the statements after a line that set parts of an array, or change it in place."""
    for node in walk(function):
        target = node.targets[0] if isinstance(node, ast.Assign) else getattr(node, "target", None)
        if not isinstance(node, ast.Assign | ast.AugAssign) or node.lineno <= line or target is None:
            continue
        part = isinstance(target, ast.Subscript) and unparse(target.value) == name
        if part or (isinstance(node, ast.AugAssign) and unparse(target) == name and bool(called(node.value))):
            yield node


@suspicion_of(About.EVERY, ast.FunctionDef)
def every_nth_call(function: ast.FunctionDef, tree: ast.Module) -> Words:
    """Find `if self.scans % 10 == 0:`, and `if self.scans >= 10:` that sets the counter to 0, of a counter of calls."""
    numbers = named_numbers(tree)
    counters = {
        unparse(node.target): node.lineno
        for node in nodes_of(function, ast.AugAssign)
        if isinstance(node.op, ast.Add) and unparse(node.value) == "1"
    }
    zeroed = {unparse(node.targets[0]) for node in nodes_of(function, ast.Assign) if unparse(node.value) == "0"}
    for node in nodes_of(function, ast.If):
        match node.test:
            case (
                ast.BinOp(op=ast.Mod(), left=counter, right=limit)
                | ast.Compare(left=ast.BinOp(op=ast.Mod(), left=counter, right=limit))
            ):
                counted = unparse(counter) in counters
            case ast.Compare(left=counter, ops=[ast.GtE() | ast.Eq() | ast.Lt()], comparators=[limit]):
                counted = unparse(counter) in zeroed and counters.get(unparse(counter), 1e9) < node.lineno
            case _:
                continue
        times = number(limit, numbers)
        if counted and times is not None and times >= FEWEST and _publishes(function, tree):
            yield node, f"{unparse(node.test)[:60]} lets only one in {times:g} calls of {function.name} publish"


def _publishes(function: ast.FunctionDef, tree: ast.Module) -> bool:
    """Return whether a function publishes, itself or through a function that it calls."""
    speak = {each.name for each in functions(tree) if any(name == "publish" for _, name in calls(each))}
    return any(name == "publish" or name in speak for _, name in calls(function))


def _attribute(node: ast.AST) -> str:
    """Return the attribute of self that an expression such as `self.pose.x` begins with; empty if it is none."""
    while isinstance(node, ast.Attribute):
        if isinstance(node.value, ast.Name) and node.value.id == "self":
            return node.attr
        node = node.value
    return ""


def _on_purpose(name: str) -> bool:
    """Return whether a name says that it keeps a first value: by one of its words, or by a 0 at its end, as `x0`."""
    return name.endswith("0") or any(part in name.lower() for part in FIRST)


def _set_by(tree: ast.AST) -> dict[str, set[str]]:
    """Return which functions assign each attribute of self as a whole."""
    found: dict[str, set[str]] = {}
    for function in functions(tree):
        for node in nodes_of(function, ast.Attribute):
            if isinstance(node.ctx, ast.Store) and isinstance(node.value, ast.Name) and node.value.id == "self":
                found.setdefault(node.attr, set()).add(function.name)
    return found


def _copies(function: ast.FunctionDef, tree: ast.AST) -> Iterator[tuple[str, ast.expr, int]]:
    """Yield each local name that is a copy of something of self, with what it copies and the line.

    A parameter is one if the file calls the function with something of self.
    """
    for node in nodes_of(function, ast.Assign):
        if len(node.targets) != 1:
            continue
        target, value = node.targets[0], node.value
        pairs = [(target, value)]
        if isinstance(target, ast.Tuple):
            values = value.elts if isinstance(value, ast.Tuple) else [value] * len(target.elts)
            pairs = list(zip(target.elts, values, strict=False))
        yield from ((one.id, other, node.lineno) for one, other in pairs if isinstance(one, ast.Name))
    names = [each.arg for each in function.args.args if each.arg != "self"]
    for call in nodes_of(tree, ast.Call):
        if isinstance(call.func, ast.Attribute) and call.func.attr == function.name:
            yield from ((name, value, call.lineno) for name, value in zip(names, call.args, strict=False))


@suspicion_of(About.OLD_POSE)
def copied_before_a_loop(tree: ast.AST) -> Words:
    """Find a loop that drives by a copy of what a callback goes on setting."""
    set_by = _set_by(tree)
    for function in functions(tree):
        copies = [
            each
            for each in _copies(function, tree)
            if set_by.get(_attribute(each[1]), set()) - {"__init__", function.name}
        ]
        for loop in (each for each in nodes_of(function, ast.While) if called(each) & WAITS):
            names = [each for each in nodes_of(loop, ast.Name)]
            read = {each.id for each in names if isinstance(each.ctx, ast.Load)}
            anew = {each.id for each in names if isinstance(each.ctx, ast.Store)}
            lines = range(loop.lineno, (loop.end_lineno or loop.lineno) + 1)
            old = {
                name: (unparse(value), line)
                for name, value, line in copies
                if name in read - anew and line not in lines and not _on_purpose(name)
            }
            if old:
                words = ", ".join(name for name in list(old)[:MOST])
                whole = ", ".join(dict.fromkeys(value for value, _ in list(old.values())[:MOST]))
                verb = "are copies" if len(old) > 1 else "is a copy"
                yield (
                    next(iter(old.values()))[1],
                    f"{words} {verb} of {whole}, made before the loop in line {loop.lineno}, which therefore goes on "
                    "with the values from before: read them again in every iteration",
                )
                break


@suspicion_of(About.FIRST_KEPT, ast.FunctionDef)
def first_message_kept(function: ast.FunctionDef, tree: ast.AST) -> Words:
    """Find a callback that takes what it keeps from its first message only."""
    message = {each.arg for each in function.args.args if each.arg != "self"}
    for test in nodes_of(function, ast.If):
        name = _tested_for_none(test.test)
        inside = [each for part in test.body for each in walk(part)]
        sets = [each for each in inside if isinstance(each, ast.Assign) and _sets(each, name)]
        if not name or _on_purpose(name) or not sets:
            continue
        others = [each for each in nodes_of(tree, ast.Assign) if _sets(each, name)]
        anew = [each for each in others if each not in sets and unparse(each.value) != "None"]
        if not anew and {each.id for each in nodes_of(sets[0].value, ast.Name)} & message:
            yield (
                sets[0],
                f"self.{name} is set only while it is None, so {function.name} keeps its first message and passes "
                "over all later ones: set it with each message",
            )


@suspicion_of(About.FIRST_KEPT, ast.FunctionDef)
def returns_when_set(function: ast.FunctionDef, tree: ast.AST) -> Words:
    """Find a callback that returns at once when it has kept a message before."""
    message = {each.arg for each in function.args.args if each.arg != "self"}
    for place, test in enumerate(function.body):
        if not isinstance(test, ast.If) or unparse(test.body[-1]) not in ("return", "return None"):
            continue
        name = _tested_for_a_value(test.test)
        behind = [node for part in function.body[place + 1 :] for node in walk(part)]
        sets = [node for node in behind if isinstance(node, ast.Assign) and _sets(node, name)]
        others = [node for node in nodes_of(tree, ast.Assign) if _sets(node, name)]
        anew = [node for node in others if node not in sets and unparse(node.value) != "None"]
        if not name or _on_purpose(name) or not sets or anew:
            continue
        if {node.id for node in nodes_of(sets[0].value, ast.Name)} & message:
            yield (
                test,
                f"{function.name} returns here as soon as self.{name} is set, so it keeps its first message and "
                "passes over all later ones: set it with each message",
            )


@suspicion_of(About.FIRST_KEPT, ast.FunctionDef)
def set_by_default(function: ast.FunctionDef) -> Words:
    """Find a callback that keeps its message by `setdefault`, which keeps the first one."""
    message = {each.arg for each in function.args.args if each.arg != "self"}
    made = {name for t, v in assigned(function) if _names(v) & message for name in _names(t)}
    for call, name in calls(function):
        kept = isinstance(call.func, ast.Attribute) and unparse(call.func.value).startswith("self.")
        if name != "setdefault" or not kept or len(call.args) != 2 or _is_empty(call.args[1]):
            continue
        if _names(call.args[1]) & (message | made) and not _on_purpose(unparse(call)):
            yield (
                call,
                f"setdefault() sets what is not set yet, so {function.name} keeps its first message and passes "
                "over all later ones: [key] = value sets it with each message",
            )


def _names(node: ast.AST) -> set[str]:
    return {each.id for each in nodes_of(node, ast.Name)}


def _is_empty(node: ast.expr) -> bool:
    return unparse(node) in ("[]", "{}", "list()", "dict()", "set()")


def _tested_for_a_value(test: ast.expr) -> str:
    """Return the attribute of `self.x is not None` or `self.x`; empty for another test."""
    if isinstance(test, ast.Compare) and isinstance(test.ops[0], ast.IsNot):
        return _attribute(test.left) if unparse(test.comparators[0]) == "None" else ""
    return _attribute(test)


def _tested_for_none(test: ast.expr) -> str:
    """Return the attribute of `self.x is None` or `not self.x`; empty for another test."""
    if isinstance(test, ast.Compare) and isinstance(test.ops[0], ast.Is) and unparse(test.comparators[0]) == "None":
        return _attribute(test.left)
    return _attribute(test.operand) if isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not) else ""


def _sets(node: ast.Assign, name: str) -> bool:
    return any(
        isinstance(each, ast.Attribute) and isinstance(each.ctx, ast.Store) and _attribute(each) == name
        for target in node.targets
        for each in walk(target)
    )


@suspicion_of(About.POSE)
def oldest_taken(tree: ast.AST) -> Words:
    """Find `self.poses[0]` as the pose of now, where each message is appended to `self.poses`."""
    listening = [each for each in functions(tree) if ".pose.pose" in unparse(each) or "_odom" in each.name]
    kept: dict[str, str] = {}
    for function in listening:
        for call, name in calls(function):
            if name in ADDS and isinstance(call.func, ast.Attribute) and isinstance(call.func.value, ast.Attribute):
                kept[unparse(call.func.value)] = name
    for function in functions(tree):
        for target, value in assigned(function):
            if isinstance(value, ast.Call) and unparse(value) in {f"min({each})" for each in kept}:
                yield value, f"{unparse(value)} is the oldest pose that is kept: [-1] is the newest"
            part = value.value if isinstance(value, ast.Attribute) else value
            whole = part.value if isinstance(part, ast.Subscript) else part
            name, adds = unparse(whole), kept.get(unparse(whole), "")
            if not isinstance(part, ast.Subscript) or not adds or _is_on_purpose(target):
                continue
            old, new = ("0", "-1") if adds == "append" else ("-1", "0")
            if unparse(part.slice) == old and f"{name}[{new}]" not in unparse(function):
                yield (
                    part,
                    f"{name}[{old}] is the oldest pose that is kept, not the present one, because {adds}() adds at the "
                    f"other end: {name}[{new}] is the newest",
                )


def _is_on_purpose(target: ast.expr) -> bool:
    return any(part in unparse(target).lower() for part in FIRST)
