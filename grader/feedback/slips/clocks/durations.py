"""Times that are no time that has passed: of two clocks, always 0, in nanoseconds, since the last call."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping

from gz_course.grader.feedback.facts.clocks import ASKED, dotted, imported
from gz_course.grader.feedback.facts.syntax import (
    Place,
    Words,
    assigned,
    calls,
    children,
    functions,
    last_name,
    nodes_of,
    unparse,
    walk,
)
from gz_course.grader.feedback.slips import slip, slip_of

OF_STAMPS = re.compile(r"\bheader\.stamp\b|\.nanosec\b|get_clock\(\)\.now\(\)")
STEPS = 4  # names followed at most
IN_SECONDS = re.compile(r"1e-?0?9|10\s*\*\*\s*-?9|1_?000_?000_?000(?:\.0)?|1000000000")
ERROR = re.compile(r"err|diff|dev", re.IGNORECASE)
TIME = re.compile(r"\bnow\b|clock|stamp|nanosec|time", re.IGNORECASE)  # in what makes a time
LONG = 1.0  # [s] or more is no time between two calls


@slip
def mixed(tree: ast.Module) -> Iterator[Place]:
    """Find `time.time() - stamp` and comparisons of the two, also by way of names."""
    names = imported(tree)
    values = _values(tree)
    if not any(_wall(node, {}, names, 0) for node in tree.body):
        return
    for node in walk(tree):
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Sub):
            sides = node.left, node.right
        elif isinstance(node, ast.Compare) and len(node.ops) == 1:
            sides = node.left, node.comparators[0]
        else:
            continue
        for one, other in (sides, sides[::-1]):
            wall, stamps = _wall(one, values, names, STEPS), _wall(other, values, names, STEPS)
            if wall and not stamps and _of_stamps(other, values, STEPS) and not _of_stamps(one, values, STEPS):
                yield (
                    node.lineno,
                    f"{unparse(node)[:70]}: {wall}() is the time of the computer, and the other side is simulated "
                    "time, which begins at 0: their difference is no age; self.get_clock().now() is the node's time",
                )
                break


def _values(tree: ast.AST) -> dict[str, list[ast.expr]]:
    found: dict[str, list[ast.expr]] = {}
    for node in nodes_of(tree, ast.Assign):
        if len(node.targets) == 1:
            found.setdefault(unparse(node.targets[0]), []).append(node.value)
    return found


def _known(node: ast.AST, values: dict[str, list[ast.expr]]) -> Iterator[ast.expr]:
    """Yield what is assigned to the names in an expression."""
    for each in nodes_of(node, ast.Name, ast.Attribute):
        yield from values.get(unparse(each), [])


def _wall(node: ast.AST, values: dict[str, list[ast.expr]], names: dict[str, str], steps: int) -> str:
    """Return the call that reads the computer's clock in an expression; empty if none does."""
    for each in nodes_of(node, ast.Call):
        if dotted(each.func, names) in ASKED - {"rclpy.clock.Clock"}:
            return unparse(each.func)
    found = (_wall(each, values, names, steps - 1) for each in _known(node, values)) if steps else iter(())
    return next(filter(None, found), "")


def _of_stamps(node: ast.AST, values: dict[str, list[ast.expr]], steps: int) -> bool:
    if OF_STAMPS.search(unparse(node)):
        return True
    return steps > 0 and any(_of_stamps(each, values, steps - 1) for each in _known(node, values))


@slip
def updated_too_early(tree: ast.AST) -> Iterator[Place]:
    """Find `self.last = now` and after it `now - self.last`, where neither gets another value in between."""
    own = {function.name: function for function in functions(tree)}
    for function in own.values():
        yield from _in_block(function.body, {}, own)


def _in_block(
    body: list[ast.stmt], kept: dict[str, tuple[str, int]], own: Mapping[str, ast.FunctionDef]
) -> Iterator[Place]:
    """Go through statements in their order; `kept` holds which name is a copy of which, and since which line.

    `own` are the functions of the file into which a statement may pass a value; empty if they are not looked into.
    """
    for statement in body:
        inner = [getattr(statement, name, []) for name in ("body", "orelse", "finalbody")]
        heads = [each for each in children(statement) if isinstance(each, ast.expr)]
        for node in (each for head in heads for each in walk(head)):
            if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Sub):
                left, right = unparse(node.left), unparse(node.right)
                for one, other in ((right, left), (left, right)):
                    known = kept.get(one) or ("", 0)
                    if known[0] == other:
                        yield (
                            node.lineno,
                            f"{unparse(node)[:60]} is always 0, because line {known[1]} has made {one} the same as "
                            f"{other}: do that after the difference is taken",
                        )
                        return
            elif isinstance(node, ast.Call) and last_name(node.func) in own:
                yield from _passed_on(node, own[last_name(node.func)], kept)
        if isinstance(statement, ast.FunctionDef | ast.ClassDef | ast.For | ast.While | ast.AsyncFunctionDef):
            kept.clear()  # what a loop assigns may come before what it reads
            continue
        for part in inner:
            if isinstance(part, list):
                yield from _in_block(part, dict(kept), own)
        changed = {unparse(target) for target, _ in assigned(statement)}
        for name in [name for name, (of, _) in kept.items() if {name, of} & changed]:
            del kept[name]
        if isinstance(statement, ast.Assign):
            for target, value in assigned(statement):
                if isinstance(target, ast.Attribute) and isinstance(value, ast.Name) and value.id not in changed:
                    kept[unparse(target)] = (value.id, statement.lineno)


def _passed_on(call: ast.Call, function: ast.FunctionDef, kept: dict[str, tuple[str, int]]) -> Iterator[Place]:
    """Go through a function that is called with what an attribute of self is a copy of."""
    names = [each.arg for each in function.args.args if each.arg != "self"]
    given = {unparse(value): name for name, value in zip(names, call.args, strict=False)}
    inner = {
        kept_name: (given[of], line)
        for kept_name, (of, line) in kept.items()
        if of in given and kept_name.startswith("self.")
    }
    if inner:
        yield from _in_block(function.body, inner, {})


@slip
def per_nanosecond(tree: ast.AST) -> Iterator[Place]:
    """Find `(error - last_error) / dt` and `total += error * dt` where dt is a difference of nanoseconds."""
    text = unparse(tree)
    if ".nanoseconds" not in text or IN_SECONDS.search(text) or re.search(r"\b1000000000(?:\.0)?\b", text):
        return
    times = _times(tree)
    values = {unparse(target): value for target, value in assigned(tree)}
    spans = {name: value for name, value in values.items() if _is_span(value, times)}
    for node in nodes_of(tree, ast.BinOp):
        if not isinstance(node.op, ast.Div | ast.Mult):
            continue
        for one, span in ((node.left, node.right), (node.right, node.left)):
            if isinstance(node.op, ast.Div) and span is node.left:
                continue
            name = unparse(span)
            if name not in spans and not _is_span(span, times):
                continue
            amount = values.get(unparse(one), one)
            change = isinstance(amount, ast.BinOp) and isinstance(amount.op, ast.Sub) and not _is_span(amount, times)
            if change or ERROR.search(unparse(one)):
                how = "small" if isinstance(node.op, ast.Div) else "large"
                yield (
                    node.lineno,
                    f"{unparse(node)[:60]}: {name[:40]} is in nanoseconds, so this is 1e9 times too {how}; divide "
                    "the time by 1e9 first, for seconds",
                )
                return


def _times(tree: ast.AST) -> set[str]:
    """Return the names that hold a number of nanoseconds, also as the arguments of the file's own functions."""
    own = {
        function.name: [each.arg for each in function.args.args if each.arg != "self"] for function in functions(tree)
    }
    found: set[str] = set()
    for _ in range(2):
        for target, value in assigned(tree):
            if _is_time(value, found):
                found.add(unparse(target))
        for call, _name in calls(tree):
            for name, value in zip(own.get(last_name(call.func), []), call.args, strict=False):
                if _is_time(value, found):
                    found.add(name)
    return found


def _is_time(value: ast.expr, found: set[str]) -> bool:
    return (isinstance(value, ast.Attribute) and value.attr == "nanoseconds") or unparse(value) in found


def _is_span(value: ast.expr, times: set[str]) -> bool:
    """Say whether an expression is how much time has passed, in nanoseconds."""
    if isinstance(value, ast.Attribute) and value.attr == "nanoseconds":
        return isinstance(value.value, ast.BinOp) and isinstance(value.value.op, ast.Sub)
    return isinstance(value, ast.BinOp) and isinstance(value.op, ast.Sub) and _is_time(value.left, times)


@slip_of(ast.FunctionDef)
def set_anew(function: ast.FunctionDef) -> Words:
    """Find `now - self.start` that is compared with seconds, where each call also sets `self.start = now`."""
    always = {
        unparse(statement.targets[0]): statement
        for statement in function.body
        if isinstance(statement, ast.Assign) and isinstance(statement.targets[0], ast.Attribute)
    }
    since: dict[str, str] = {}  # name of a difference -> its start
    for node in nodes_of(function, ast.Assign):
        if start := _start(node.value, always):
            since[unparse(node.targets[0])] = start
    for asked in nodes_of(function, ast.Compare):
        if not _is_long(asked.comparators[0]):
            continue
        start = _start(asked.left, always) or since.get(unparse(asked.left), "")
        if start:
            line = always[start].lineno
            yield (
                line,
                f"{start} is set again in every call of {function.name}, so line {asked.lineno} compares the time "
                "since the last call: what is measured from the start is set once",
            )


def _start(value: ast.expr, always: dict[str, ast.Assign]) -> str:
    """Return the start of which a time is the difference, if each call sets it to the same end."""
    for node in nodes_of(value, ast.BinOp):
        if isinstance(node.op, ast.Sub):
            start, end = unparse(node.right), unparse(node.left)
            if start in always and unparse(always[start].value) == end:
                return start
    return ""


def _is_long(value: ast.expr) -> bool:
    """Return whether an expression is a number, or a Duration, of a second or more."""
    numbers = [each.value for each in nodes_of(value, ast.Constant) if isinstance(each.value, int | float)]
    return any(number >= LONG for number in numbers)


@slip
def added_up(tree: ast.AST) -> Iterator[Place]:
    """Find `self.driven += now - self.start` in a callback that does not set the start anew."""
    once = {
        unparse(target)
        for node in nodes_of(tree, ast.If)
        if _asks_for_none(node.test)
        for statement in node.body
        for target, value in assigned(statement)
        if TIME.search(unparse(value))
    }
    for function in functions(tree):
        inside = {
            id(each)
            for node in nodes_of(function, ast.If)
            if _asks_for_none(node.test)
            for statement in node.body
            for each in walk(statement)
        }
        again = {unparse(target) for target, value in assigned(function) if id(value) not in inside}
        for node in nodes_of(function, ast.AugAssign):
            if not isinstance(node.op, ast.Add):
                continue
            for each in nodes_of(node.value, ast.BinOp):
                if isinstance(each.op, ast.Sub):
                    start = unparse(each.right)
                    if start in once - again and start.startswith("self."):
                        yield (
                            node.lineno,
                            f"{unparse(node)[:70]} adds the whole time since {start} in every call, although "
                            f"{start} stays the same: that time is a difference, with = and not +=",
                        )


def _asks_for_none(test: ast.expr) -> bool:
    return isinstance(test, ast.UnaryOp) or unparse(test).endswith("is None")
