"""Suspects in an action server that drives: when it asks for a cancellation, what it says, where it thinks it is."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from typing import TypeGuard

from gz_course.grader.feedback.facts.syntax import Words, assigned, called, calls, functions, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

BEFORE = ("followers", "goal_flags", "old_values")

ASKS = "is_cancel_requested"
ANGLE = re.compile(r"turn|err|angle|diff|delta|alpha|beta")
STEPS = frozenset({"publish", "publish_feedback", "sleep"})  # what every round of a loop that drives does
WAITS = frozenset({"sleep", "spin_once", "ok", "time", "monotonic", "now", "get_clock", "wait_for_server"})
LOGS = frozenset({"get_logger", "debug", "info", "warn", "warning", "error", "print"})
Loop = ast.While | ast.For
AnyLoop = ast.While | ast.For | ast.AsyncFor
SENDS = "publish_feedback"
CLOCK = re.compile(r"nanosec|now|time|monotonic|Duration")  # a condition on the time is a rate, and may be right
DRIVES = frozenset({"publish"})  # what a round of a loop that drives does; one that only sleeps waits


def _asks(node: ast.AST) -> list[int]:
    """Return the lines that ask for a cancellation."""
    return sorted(each.lineno for each in nodes_of(node, ast.Attribute) if each.attr == ASKS)


def _askers(tree: ast.AST) -> set[str]:
    """Return the functions that ask for a cancellation, themselves or by a function that they call."""
    functions = [each for each in nodes_of(tree, ast.FunctionDef, ast.AsyncFunctionDef)]
    found = {each.name for each in functions if _asks(each)}
    for _ in functions:
        more = {each.name for each in functions if called(each) & found} - found
        if not more:
            break
        found |= more
    return found


def _asked_by(node: ast.AST) -> TypeGuard[ast.If]:
    """Return whether a node is an `if` that asks for a cancellation."""
    return isinstance(node, ast.If) and bool(_asks(node.test))


@suspicion_of(About.CANCEL)
def asked_under_a_condition(tree: ast.AST) -> Words:
    """Find `if index == 0 and goal_handle.is_cancel_requested`."""
    for test in (each for each in walk(tree) if _asked_by(each)):
        if not isinstance(test.test, ast.BoolOp) or not isinstance(test.test.op, ast.And):
            continue
        others = " and ".join(unparse(each) for each in test.test.values if not _asks(each))
        leaves = any(isinstance(part, ast.Return | ast.Break) for part in test.body)
        if others and (leaves or "canceled" in called(test)):
            yield test, f"a cancellation counts only if `{others[:80]}` is true, too"


@suspicion_of(About.NO_PLACE)
def velocities_for_places(tree: ast.AST) -> Words:
    """Find a program that reads the velocity of the odometry, and nowhere its position."""
    named = {each.attr: each for each in nodes_of(tree, ast.Attribute)}
    if "position" in named or not called(tree) & {"hypot", "sqrt", "dist", "norm", "atan2"}:
        return
    whole = {unparse(target) for target, value in assigned(tree) if unparse(value).endswith(".twist.twist")}
    for node in nodes_of(tree, ast.Attribute):
        if isinstance(node.ctx, ast.Load) and node.attr in ("x", "y"):
            owner = unparse(node.value)
            if owner.endswith(".twist.linear") or owner.removesuffix(".linear") in whole:
                yield (
                    node,
                    f"{unparse(node)} is a velocity of the robot, and nothing here reads where it is: "
                    "pose.pose.position of the odometry",
                )
                return


@suspicion_of(About.CANCEL)
def loops_that_do_not_ask(tree: ast.AST) -> Words:
    """Find a loop that drives without asking for a cancellation, in a file that asks for it elsewhere."""
    lines, askers = _asks(tree), _askers(tree)
    if not lines:
        return
    answering = {id(n) for test in walk(tree) if _asked_by(test) for part in test.body for n in walk(part)}
    for loop in walk(tree):
        if id(loop) in answering:
            continue  # it belongs to what is done about a cancellation
        if not isinstance(loop, Loop) or not called(loop) & STEPS or _asks(loop) or called(loop) & askers:
            continue
        if not set().union(*map(called, loop.body)) - WAITS - LOGS:
            continue  # it only waits, such as for the first message
        if any(isinstance(each, Loop) and each is not loop and called(each) & STEPS for each in walk(loop)):
            continue
        around = any(isinstance(n, Loop) and loop in walk(n) and lines[0] in _asks(n) for n in walk(tree))
        where = "for each waypoint, " if around else ""
        when = f"line {lines[0]} asks it {'once ' if around else ''}{where}outside of"
        yield loop, f"the loop that drives does not ask goal_handle.{ASKS}; {when} this loop"


@suspicion_of(About.CANCEL)
def breaks_of_the_inner_loop(tree: ast.AST) -> Words:
    """Find a cancelled goal that breaks out of the inner of two loops, where nothing ends the outer one."""
    for outer in (n for n in walk(tree) if isinstance(n, Loop)):
        for place, inner in enumerate(outer.body):
            if not isinstance(inner, Loop) or inner.orelse:
                continue
            behind = [each for part in outer.body[place + 1 :] for each in walk(part)]
            asked = [each for each in nodes_of(inner, ast.If) if _asks(each.test)]
            left = [part for each in asked for part in each.body if isinstance(part, ast.Break)]
            ahead = any(_asks(part) for part in outer.body[:place])
            if left and not ahead and not any(isinstance(each, ast.If | ast.Break | ast.Return) for each in behind):
                yield (
                    left[0],
                    f"this break leaves the inner loop only, and the loop in line {outer.lineno} goes on with the next "
                    "waypoint: return from execute here, after canceled() and a Twist of zeros",
                )


def _lines_of_init(tree: ast.AST) -> set[int]:
    functions = (n for n in nodes_of(tree, ast.FunctionDef) if n.name == "__init__")
    return {line for each in functions for line in range(each.lineno, (each.end_lineno or each.lineno) + 1)}


@suspicion_of(About.RESULT)
def counts_that_go_on(tree: ast.AST) -> Words:
    """Find a Result, or a count for one, that is made in the constructor and counted up by every goal."""
    if not called(tree) & {"succeed"}:
        return  # it executes no goals
    made: dict[str, list[ast.Assign]] = {}
    counted = {}
    for node in walk(tree):
        if isinstance(node, ast.Assign):
            for target in node.targets:
                made.setdefault(unparse(target), []).append(node)
        elif isinstance(node, ast.AugAssign) and isinstance(node.op, ast.Add):
            counted[unparse(node.target)] = node.lineno
    handed = {unparse(n.value) for n in nodes_of(tree, ast.Assign, ast.keyword)}
    first = _lines_of_init(tree)
    for name, line in counted.items():
        whole, _, field = name.rpartition(".")
        own = made.get(whole, [])
        if whole.startswith("self.") and len(own) == 1 and own[0].lineno in first and name not in made:
            made_by = unparse(own[0].value)
            if made_by.rpartition(".")[2].startswith("Result("):
                yield (
                    own[0],
                    f"{whole} is made once for all goals, and line {line} counts {field} on: {made_by} belongs in "
                    "the function that executes a goal",
                )
        begun = made.get(name, [])
        if whole == "self" and len(begun) == 1 and begun[0].lineno in first and name in handed:
            yield (
                begun[0],
                f"{name} is set once for all goals, and line {line} counts it on: reset it where a goal is executed",
            )


@suspicion_of(About.ONE_SIDE, ast.If)
def one_side_of_an_angle(node: ast.If) -> Words:
    """Find `if turn < 0.3:` before the robot drives: an angle to the other side is always below that."""
    if not isinstance(node.test, ast.Compare) or len(node.test.ops) != 1:
        return
    left, limit = unparse(node.test.left), unparse(node.test.comparators[0])
    drives = any(
        unparse(target).endswith("linear.x") and unparse(value) not in ("0", "0.0")
        for part in node.body
        for target, value in assigned(part)
    )
    angle = isinstance(node.test.left, ast.Name | ast.Attribute) and ANGLE.search(left)
    if drives and angle and isinstance(node.test.ops[0], ast.Lt | ast.LtE) and not limit.startswith("-"):
        yield (
            f"{left} < {limit} is true for every negative {left}, too, however far to the right: compare abs({left})"
        )


@suspicion_of(About.SUMMED_PLACE, ast.AugAssign)
def summed_places(node: ast.AugAssign) -> Words:
    """Find a place that is a sum of velocities, where the odometry says the place itself."""
    if not isinstance(node.op, ast.Add):
        return
    if ".twist.linear" in unparse(node.value) and unparse(node.target).startswith("self."):
        yield (
            f"{unparse(node.target)} is a sum of velocities, which are in the frame of the robot and turn "
            "with it; the place in the frame odom is pose.pose.position of the message"
        )


def _turns(block: list[ast.stmt]) -> bool:
    return any(
        unparse(target).endswith("angular.z") and unparse(value) not in ("0", "0.0")
        for part in block
        for target, value in assigned(part)
    )


def _phases(tree: ast.AST) -> Iterator[tuple[str, object]]:
    """Yield the name of a phase, and its value in which alone the robot turns."""
    for node in nodes_of(tree, ast.If):
        name = ""
        value: object = None
        match node.test:
            case ast.Compare(left=left, ops=[ast.Eq()], comparators=[ast.Constant() as constant]):
                name, value = unparse(left), constant.value
            case ast.UnaryOp(ast.Not(), ast.Name() | ast.Attribute() as left):
                name, value = unparse(left), False
            case ast.Name() | ast.Attribute() as left if not _turns(node.body) and _turns(node.orelse):
                yield unparse(left), False
        if name and _turns(node.body) and not _turns(node.orelse):
            yield name, value


@suspicion_of(About.PHASE)
def phases_that_stay_over(tree: ast.AST) -> Words:
    """Find a phase of turning that begins once, before the loop, and that the loop only leaves."""
    for name, value in _phases(tree):
        begins: list[tuple[ast.Assign, bool]] = []
        ends: list[tuple[ast.Assign, bool]] = []
        for function in functions(tree):
            straight = {id(statement) for statement in function.body}
            for statement in nodes_of(function, ast.Assign):
                for target, given in assigned(statement):
                    if unparse(target) != name:
                        continue
                    same = isinstance(given, ast.Constant) and given.value == value
                    (begins if same else ends).append((statement, id(statement) in straight))
        if begins and len(ends) == 1 and all(straight for _, straight in begins):
            (end, _), before = ends[0], begins[-1][0]
            if isinstance(end.value, ast.Constant):
                yield (
                    end,
                    f"{unparse(end)} ends the turning for good: nothing sets it back to "
                    f"{unparse(before.value)} for the next waypoint",
                )
                return


def _reaching(tree: ast.AST, names: frozenset[str]) -> set[str]:
    """Return names, and those of the functions that call one of them, themselves or by another function."""
    found, own = set(names), list(functions(tree))
    for _ in own:
        more = {each.name for each in own if called(each) & found} - found
        if not more:
            break
        found |= more
    return found


def _drivers(tree: ast.AST, node: ast.AST) -> Iterator[AnyLoop]:
    """Yield the innermost loops that drive, in a node and in the functions that it calls."""
    places = [node, *(each for each in functions(tree) if each.name in called(node))]
    steps = _reaching(tree, DRIVES)
    for place in places:
        for loop in (each for each in walk(place) if isinstance(each, AnyLoop)):
            inner = [each for each in walk(loop) if isinstance(each, AnyLoop) and each is not loop]
            if called(loop) & steps and not any(called(each) & steps for each in inner):
                yield loop


@suspicion_of(About.RARE_FEEDBACK)
def outside_of_the_loop(tree: ast.AST) -> Words:
    """Find feedback beside the loop that drives, where no loop that drives sends any."""
    if SENDS not in called(tree):
        return
    sending = _reaching(tree, frozenset({SENDS}))
    for function in functions(tree):
        drivers = list(_drivers(tree, function))
        if not drivers or any(called(each) & sending for each in drivers):
            continue
        for call, name in calls(function):
            if name in sending:
                yield call, f"{name}() stands outside of the loop of line {drivers[0].lineno}, which drives the robot"


@suspicion_of(About.RARE_FEEDBACK)
def under_a_condition(tree: ast.AST) -> Words:
    """Find the only call that sends feedback under a condition."""
    sent = [call for call, name in calls(tree) if name == SENDS]
    if len(sent) != 1:
        return
    around = [
        node for node in nodes_of(tree, ast.If) if any(each is sent[0] for part in node.body for each in walk(part))
    ]
    if around and not CLOCK.search(unparse(around[-1].test)):  # the innermost one is walked to last
        yield sent[0], f"{SENDS}() is called only if `{unparse(around[-1].test)[:80]}`"
