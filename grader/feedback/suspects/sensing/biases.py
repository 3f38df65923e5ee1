"""Suspects in the bias of a gyroscope and the angle that it gives: how and when it is measured, used, set back."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.constants import named_numbers, number
from gz_course.grader.feedback.facts.syntax import Words, assigned, calls, functions, last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About
from gz_course.grader.feedback.suspects.sensing.gyroscopes import angle_sums, assigned_once, expanded, reads_rates

BIAS = re.compile(r"(?:^|[._])(?:\w*bias\w*|offset|drift)$", re.IGNORECASE)
Guards = frozenset[tuple[str, bool]]  # conditions under which a statement is reached, and whether they hold
ADDS = frozenset({"append", "appendleft"})
LEAVES = (ast.Return, ast.Continue, ast.Break, ast.Raise)


def _biases(node: ast.AST) -> set[str]:
    """Return the names in an expression that stand for a bias."""
    parts = (unparse(each) for each in nodes_of(node, ast.Name, ast.Attribute))
    return {each for each in parts if BIAS.search(each)}


@suspicion_of(About.GYROSCOPE)
def subtracted_as_an_angle(tree: ast.AST) -> Words:
    """Find a bias [rad/s] that is taken from the heading [rad], once or in each step without a time."""
    sums = [found for function in reads_rates(tree) for found in angle_sums(function)]
    for node, _, value, whole in sums:
        if (
            isinstance(whole, ast.BinOp)
            and isinstance(whole.op, ast.Sub)
            and isinstance(value, ast.BinOp)
            and isinstance(whole.left, ast.BinOp)
            and isinstance(whole.left.op, ast.Mult)
            and isinstance(value.right, ast.Name | ast.Attribute)
            and _biases(value.right)
        ):
            yield (
                node,
                f"{unparse(node)[:70]} subtracts the bias, a rate [rad/s], from an angle [rad]: (rate - bias) * time",
            )
    for name in {name for _, name, _, _ in sums}:
        if any(_biases(whole) or _biases(value) for _, each, value, whole in sums if each == name):
            continue
        for target, value in assigned(tree):
            if unparse(target) == name and _biases(value) and "angular_velocity" not in unparse(value):
                yield (
                    value,
                    f"{name} gets {unparse(value)[:40]}: the bias is taken from the angle [rad], once, but it is a "
                    "rate [rad/s], wrong in every message: add (rate - bias) * time each time",
                )


@suspicion_of(About.GYROSCOPE)
def never_used(tree: ast.AST) -> Words:
    """Find a bias that is measured, and read nowhere but where it is measured."""
    if not any(True for _ in reads_rates(tree)):
        return
    for name in sorted({unparse(t) for t, _ in assigned(tree) if isinstance(t, ast.Name | ast.Attribute)}):
        if not BIAS.search(name):
            continue
        places = [value for target, value in assigned(tree) if unparse(target) == name]
        own = {id(each) for value in places for each in walk(value)}
        tail = name.rpartition(".")[2]
        read = any(
            isinstance(each, ast.Name | ast.Attribute)
            and isinstance(each.ctx, ast.Load)
            and unparse(each).rpartition(".")[2] == tail
            and id(each) not in own
            for each in walk(tree)
        )
        measured = [value for value in places if not isinstance(value, ast.Constant)]
        if not read and measured:
            yield measured[0], f"{name} is measured here and subtracted nowhere: add (rate - {name}) * time"


@suspicion_of(About.GYROSCOPE)
def sums_for_means(tree: ast.AST) -> Words:
    """Find a running sum of the standing rates that is subtracted as the bias, and divided nowhere."""
    sums = {
        unparse(node.target): node
        for function in reads_rates(tree)
        for node in nodes_of(function, ast.AugAssign)
        if isinstance(node.op, ast.Add) and _is_rate(node.value, function)
    }
    divided = " ".join(
        unparse(node.left if isinstance(node, ast.BinOp) else node.target)
        for node in nodes_of(tree, ast.BinOp, ast.AugAssign)
        if isinstance(node.op, ast.Div)
    )
    for node in nodes_of(tree, ast.BinOp):
        if isinstance(node.op, ast.Sub):
            made = sums.get(unparse(node.right))
            if made is not None and unparse(node.right) not in divided:
                yield (
                    made,
                    f"{unparse(made)[:60]} is the sum of the rates, and it is subtracted as their mean: divide it "
                    "by their number",
                )


def _is_rate(value: ast.expr, function: ast.FunctionDef) -> bool:
    """Say whether an expression is a turning rate alone, with no time beside it."""
    return unparse(expanded(value, assigned_once(function))).endswith("angular_velocity.z")


@suspicion_of(About.GYROSCOPE)
def collected_in_the_turn(tree: ast.AST) -> Words:
    """Find rates that go into the bias in every call in which the heading grows."""
    for function in reads_rates(tree):
        values, reached = assigned_once(function), dict(_reached(function.body, frozenset()))
        for node, _, _, whole in angle_sums(function):
            live = [each for each, guards in reached.items() if guards <= reached.get(node, frozenset())]
            for statement in live:
                if statement is not node and _kept(statement, values) & _subtracted(whole, live, values):
                    yield (
                        statement,
                        f"{unparse(statement)[:70]} is done while the robot turns, too, so the turn itself is "
                        "subtracted as if it were bias: collect the rates only in the first second, while it stands",
                    )


def _reached(body: list[ast.stmt], guards: Guards) -> Iterator[tuple[ast.stmt, Guards]]:
    """Yield the statements of a block, and of the blocks in it, with the conditions under which each is reached."""
    for statement in body:
        yield statement, guards
        if isinstance(statement, ast.If):
            test = unparse(statement.test)
            yield from _reached(statement.body, guards | {(test, True)})
            yield from _reached(statement.orelse, guards | {(test, False)})
            for branch, holds in ((statement.body, False), (statement.orelse, True)):
                if branch and isinstance(branch[-1], LEAVES):
                    guards |= {(test, holds)}
        elif isinstance(statement, ast.With | ast.Try):
            yield from _reached(statement.body, guards)


def _kept(statement: ast.stmt, values: dict[str, ast.expr]) -> set[str]:
    """Return the attributes into which a statement puts a rate."""
    match statement:
        case ast.Assign(targets=[ast.Attribute() as target], value=value):
            pass
        case ast.AugAssign(target=ast.Attribute() as target, value=value):
            pass
        case ast.Expr(value=ast.Call(func=ast.Attribute(value=ast.Attribute() as target), args=[value]) as call):
            if last_name(call.func) not in ADDS:
                return set()
        case _:
            return set()
    return {unparse(target)} if "angular_velocity" in unparse(expanded(value, values)) else set()


def _subtracted(whole: ast.expr, live: list[ast.stmt], values: dict[str, ast.expr]) -> set[str]:
    """Return the attributes that what is subtracted from a rate is made of, in the statements of the same call."""
    found = {
        name
        for node in nodes_of(whole, ast.BinOp)
        if isinstance(node.op, ast.Sub) and "angular_velocity" in unparse(node.left)
        for name in _attributes(node.right)
    }
    for statement in live:
        if isinstance(statement, ast.Assign) and {unparse(each) for each in statement.targets} & found:
            found |= _attributes(expanded(statement.value, values))
    return found


def _attributes(node: ast.AST) -> set[str]:
    return {unparse(each) for each in nodes_of(node, ast.Attribute)}


@suspicion_of(About.GYROSCOPE)
def orientations(tree: ast.AST) -> Words:
    """Find the orientation in a message of a gyroscope where its rates are read nowhere."""
    heard = {
        last_name(call.args[2])
        for call, name in calls(tree)
        if name == "create_subscription" and len(call.args) > 2 and last_name(call.args[0]) == "Imu"
    }
    for function in (each for each in functions(tree) if each.name in heard and not any(reads_rates(tree))):
        found = [node for node in nodes_of(function, ast.Attribute) if node.attr == "orientation"]
        for node in found[:1]:
            said = "the angle of an orientation jumps from pi to -pi and never comes to 2 pi: add up angular_velocity.z"
            yield node, f"{said} * time"


@suspicion_of(About.GYROSCOPE)
def set_back(tree: ast.AST) -> Words:
    """Find an angle that is set to a number just before something is added to it, in each message."""
    for function in reads_rates(tree):
        blocks = [(node, block) for node in walk(function) for block in (_block(node, "body"), _block(node, "orelse"))]
        for above, block in blocks:
            once = unparse(above.test) if isinstance(above, ast.If) and block is above.body else ""
            numbers: dict[str, ast.stmt] = {}
            for statement in block:
                match statement:
                    case ast.Assign(targets=[ast.Attribute() as target], value=ast.Constant(value=int() | float())):
                        numbers[unparse(target)] = statement
                    case ast.AugAssign(target=ast.Attribute() as target):
                        made = numbers.get(unparse(target))
                        if made is not None and unparse(target) not in once:
                            yield (
                                made,
                                f"{unparse(made)} is done before each step is added, so what was turned before is "
                                "forgotten: set it once",
                            )


def _block(node: ast.AST, name: str) -> list[ast.stmt]:
    """Return a block of a statement; empty for what has none, such as an expression."""
    block = getattr(node, name, None)
    return block if isinstance(block, list) else []


@suspicion_of(About.GYROSCOPE)
def steps_of_timers(tree: ast.AST) -> Words:
    """Find a sum in the callback of a timer that counts another time for each call than the period of the timer."""
    known = named_numbers(tree)
    periods = {
        last_name(call.args[1]): number(call.args[0], known)
        for call, name in calls(tree)
        if name == "create_timer" and len(call.args) > 1
    }
    for function in functions(tree) if any(reads_rates(tree)) else ():
        period = periods.get(function.name)
        for node in walk(function) if period else ():
            if not isinstance(node, ast.AugAssign) or not isinstance(node.op, ast.Add) or period is None:
                continue
            if not isinstance(node.value, ast.BinOp) or not isinstance(node.value.op, ast.Mult):
                continue
            step = number(node.value.right, known)
            if step and abs(step - period) > 1e-6:
                yield (
                    node,
                    f"{unparse(node)[:60]} counts {step:g} s for each call, and the timer calls {function.name} "
                    f"every {period:g} s",
                )
