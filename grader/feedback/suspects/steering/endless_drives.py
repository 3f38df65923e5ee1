"""Suspects in a drive for a time that never ends (`endless`): what is compared does not change, or changes nothing."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator
from functools import wraps

from gz_course.grader.feedback.facts.constants import named_numbers, number
from gz_course.grader.feedback.facts.syntax import (
    Words,
    assigned,
    called,
    calls,
    functions,
    kept,
    last_name,
    nodes_of,
    set_to,
    unparse,
    walk,
)
from gz_course.grader.feedback.slips.clocks.time_units import unit_of
from gz_course.grader.feedback.suspects import Suspicion, suspicion_of
from gz_course.grader.feedback.suspects.about import About

OTHER_TASKS = frozenset({
    "ActionServer", "ActionClient", "create_service", "create_client", "lookup_transform", "declare_parameters",
})  # fmt: skip
LONG = 8.0  # [s] more is no drive of a run
TIMES = frozenset({"now", "get_clock", "stamp", "time", "monotonic", "perf_counter", "sleep", "nanoseconds", "clock"})


def of_a_plain_drive(about: About) -> Callable[[Callable[[ast.Module], Words]], Suspicion]:
    """Register a suspect that is looked for in such files only."""

    def register(rule: Callable[[ast.Module], Words]) -> Suspicion:
        @wraps(rule)
        def find(tree: ast.Module) -> Words:
            if _is_plain_drive(tree):
                yield from rule(tree)

        return suspicion_of(about)(find)

    return register


@kept
def _is_plain_drive(tree: ast.Module) -> bool:
    heard = {unparse(call.args[0]) for call, name in calls(tree) if name == "create_subscription" and call.args}
    return any(set_speeds(tree)) and heard <= {"Odometry", "Clock"} and not called(tree) & OTHER_TASKS


def set_speeds(node: ast.AST) -> Iterator[tuple[ast.expr, ast.expr]]:
    """Yield the assignments of `linear.x`: the whole target, and its value."""
    return ((target, value) for target, value in assigned(node) if unparse(target).endswith(".linear.x"))


def in_init(tree: ast.AST) -> set[int]:
    """Return the nodes within the `__init__` of classes, by their identity."""
    return {id(node) for each in functions(tree) if each.name == "__init__" for node in walk(each)}


def asked_for_none(test: ast.expr) -> str:
    """Return the name of `NAME is None`, `not NAME`, `NAME < 0` and `NAME == 0`; empty for other conditions."""
    match test:
        case ast.Compare(left=left, ops=[ast.Is() | ast.Eq()], comparators=[ast.Constant(value=None | 0)]):
            return unparse(left)
        case ast.Compare(left=left, ops=[ast.Lt()], comparators=[ast.Constant(value=0)]):
            return unparse(left)
        case ast.UnaryOp(op=ast.Not(), operand=ast.Name() | ast.Attribute() as operand):
            return unparse(operand)
    return ""


def is_zero(value: ast.expr) -> bool:
    return isinstance(value, ast.Constant) and value.value == 0


def publish_calls(node: ast.AST) -> Iterator[tuple[ast.Call, str]]:
    """Yield each publish() with the code of the message."""
    for call, name in calls(node):
        if name == "publish" and call.args:
            yield call, unparse(call.args[0])


@of_a_plain_drive(About.ENDLESS)
def computed_once(tree: ast.AST) -> Words:
    """Find a time that is computed only where the start is set, and compared in every call."""
    init, values = in_init(tree), set_to(tree)
    for block in (node for node in nodes_of(tree, ast.If) if asked_for_none(node.test)):
        start = asked_for_none(block.test)
        inside = [pair for statement in block.body for pair in assigned(statement)]
        if start not in {unparse(target) for target, _ in inside}:
            continue
        for target, value in inside:
            name = unparse(target)
            others = [each for each in values[name] if each is not value and id(each) not in init]
            if name != start and not others and _has_difference(value) and _compared(tree, name):
                yield (
                    target,
                    f"{name} is computed only here, below  if {unparse(block.test)}:, which holds once; compute "
                    "it in every call",
                )


@of_a_plain_drive(About.ENDLESS)
def kept_messages(tree: ast.AST) -> Words:
    """Find a Twist that is made once, filled below a condition in a callback, and never set back to zero."""
    nodes = in_init(tree)
    sent = {message for _, message in publish_calls(tree)}
    made = {
        unparse(target).removeprefix("self."): value
        for target, value in assigned(tree)
        if isinstance(value, ast.Call) and last_name(value.func) == "Twist"
    }
    for function in (each for each in functions(tree) if each.name != "__init__"):
        own = {unparse(target) for target, _ in assigned(function)} | {each.arg for each in function.args.args}
        for block in nodes_of(function, ast.If):
            for target, value in (pair for statement in block.body for pair in set_speeds(statement)):
                message = unparse(target).removesuffix(".linear.x")
                once = message in sent - own and message.removeprefix("self.") in made
                again = any(
                    unparse(each) == message and id(given) not in nodes and message.startswith("self.")
                    for each, given in assigned(tree)
                )
                zero = any(
                    is_zero(other) or not isinstance(other, ast.Constant)
                    for each, other in set_speeds(tree)
                    if unparse(each) == unparse(target) and id(other) not in nodes
                )
                if once and not again and not zero and not is_zero(value):
                    yield (
                        target,
                        f"{message} is one message for all calls and keeps what is set here, below  "
                        f"if {unparse(block.test)[:60]}:, when the condition holds no more: set its fields to 0 "
                        "then, or make a new Twist() in every call",
                    )


def _has_difference(value: ast.expr) -> bool:
    return any(isinstance(node, ast.BinOp) and isinstance(node.op, ast.Sub) for node in walk(value))


def _compared(tree: ast.AST, name: str) -> bool:
    return any(
        isinstance(node, ast.Compare) and any(unparse(each) == name for each in (node.left, *node.comparators))
        for node in walk(tree)
    )


@of_a_plain_drive(About.ENDLESS)
def refreshed(tree: ast.AST) -> Words:
    """Find a start that another callback sets anew each time it is called."""
    starts = {
        unparse(part.right)
        for node in nodes_of(tree, ast.BinOp, ast.Compare)
        for part in nodes_of(node, ast.BinOp)
        if isinstance(part.op, ast.Sub) and isinstance(part.right, ast.Attribute)
    }
    values = set_to(tree)
    for function in (each for each in functions(tree) if each.name != "__init__"):
        own = {unparse(part.right) for part in nodes_of(function, ast.BinOp)}
        for statement in function.body:
            for target, value in assigned(statement) if isinstance(statement, ast.Assign) else ():
                name = unparse(target)
                if name in starts - own and any(last_name(each) in TIMES for each in walk(value)) and values[name]:
                    yield (
                        statement,
                        f"{name} = {unparse(value)[:40]} sets the start again in every call of {function.name}, so "
                        "the time since then stays short: set it once, if it is None",
                    )


@of_a_plain_drive(About.ENDLESS)
def default_messages(tree: ast.AST) -> Words:
    """Find a message that is the default of a parameter, and is filled below a condition and published."""
    for function in functions(tree):
        arguments, defaults = function.args.args, function.args.defaults
        for argument, default in zip(arguments[len(arguments) - len(defaults) :], defaults, strict=True):
            filled = [target for target, _ in set_speeds(function) if unparse(target).startswith(f"{argument.arg}.")]
            if filled and isinstance(default, ast.Call):
                yield (
                    function,
                    f"{argument.arg}={unparse(default)} is made once, when {function.name} is defined, and keeps "
                    f"what line {filled[0].lineno} sets from call to call: make the message in the function",
                )


@of_a_plain_drive(About.ENDLESS)
def outside_the_condition(tree: ast.AST) -> Words:
    """Find a speed that is set in every call, behind a condition that neither leaves nor sets it back."""
    for function in (each for each in functions(tree) if each.name not in ("__init__", "main")):
        for i, statement in enumerate(function.body):
            speeds = [(t, v) for t, v in set_speeds(statement) if isinstance(statement, ast.Assign) and not _varies(v)]
            before = [each for each in function.body[:i] if isinstance(each, ast.If) and not asked_for_none(each.test)]
            after = function.body[i + 1 :]
            if not speeds or is_zero(speeds[0][1]) or not before or any(_leaves(each) for each in before):
                continue
            if not any(True for each in after for _ in publish_calls(each)):
                continue
            if any(isinstance(each, ast.If) and _may_stop(each) for each in after):
                continue
            yield (
                statement,
                f"{unparse(statement)[:60]} comes after the condition of line {before[-1].lineno} and not in "
                "it, so every call sets this speed; indent it, or return where the time is over",
            )
            return


@of_a_plain_drive(About.ENDLESS)
def long_times(tree: ast.AST) -> Words:
    """Find a time in seconds that is compared with far more of them than a drive takes."""
    numbers, values = named_numbers(tree), set_to(tree)
    declared = {
        unparse(call.args[0]): value
        for call, name in calls(tree)
        if name == "declare_parameter" and len(call.args) > 1 and (value := number(call.args[1], numbers))
    }
    for node in (each for each in nodes_of(tree, ast.Compare) if len(each.ops) == 1):
        for one, other in ((node.left, node.comparators[0]), (node.comparators[0], node.left)):
            given = other
            while isinstance(given, ast.Name | ast.Attribute) and len(values.get(unparse(given), [])) == 1:
                given = values[unparse(given)][0]
            asked = [call for call, name in calls(given) if name == "get_parameter" and call.args]
            limit = declared.get(unparse(asked[0].args[0])) if asked else number(other, numbers)
            if limit and limit > LONG and unit_of(one, values, numbers) == 1.0:
                yield (
                    node,
                    f"{unparse(node)[:70]} compares a time in seconds with {limit:g}: that many seconds are longer "
                    "than the run",
                )


@of_a_plain_drive(About.ENDLESS)
def no_time_at_all(tree: ast.AST) -> Words:
    """Find a file that neither reads a clock, nor compares anything, nor cancels, nor has a second timer."""
    names = {last_name(node) for node in walk(tree)}
    asks = any(isinstance(node, ast.Compare) for function in functions(tree) for node in walk(function))
    timers = [call for call, name in calls(tree) if name == "create_timer"]
    if names & TIMES or asks or "cancel" in names or len(timers) != 1:
        return
    for target, _ in set_speeds(tree):
        yield target, "nothing in the file asks how much time has passed; the number of calls does not say it"
        return


@of_a_plain_drive(About.ENDLESS)
def not_read(tree: ast.AST) -> Words:
    """Find an attribute that a method sets to end something, and that nobody reads, or `__init__` alone."""
    for owner in nodes_of(tree, ast.ClassDef):
        init = in_init(owner)
        read: dict[str, list[ast.Attribute]] = {}
        for node in nodes_of(owner, ast.Attribute):
            if isinstance(node.ctx, ast.Load):
                read.setdefault(unparse(node), []).append(node)
        for target, value in assigned(owner):
            name = unparse(target)
            if not name.startswith("self.") or name.count(".") > 1 or not isinstance(value, ast.Constant):
                continue
            readers = read.get(name, [])
            if id(value) in init or any(id(each) not in init for each in readers):
                continue
            who = (
                f"only __init__ reads {name}, once, in line {readers[0].lineno}" if readers else f"nothing reads {name}"
            )
            yield target, f"{name} = {unparse(value)} changes nothing: {who}"


def _varies(value: ast.expr) -> bool:
    """Return whether a speed may be zero as well: it has a condition in it, or is a name."""
    return not isinstance(value, ast.Constant)


def _leaves(block: ast.If) -> bool:
    return any(isinstance(node, ast.Return | ast.Raise) for node in walk(block)) or "cancel" in called(block)


def _may_stop(block: ast.If) -> bool:
    """Return whether a block sets a speed, makes a new message, or leaves."""
    return _leaves(block) or any(True for _ in set_speeds(block)) or "Twist" in called(block)
