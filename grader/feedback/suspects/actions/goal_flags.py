"""Suspects in what an action server keeps from goal to goal: flags, events, and goals that it has rejected."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import (
    Words,
    assigned,
    called,
    calls,
    functions,
    last_name,
    nodes_of,
    unparse,
    walk,
)
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

BEFORE = ("goals",)

TURNS = frozenset({"Lock", "RLock", "Semaphore", "BoundedSemaphore"})
ENDS = frozenset({"succeed", "canceled", "abort"})


def _own(node: ast.expr) -> str:
    """Return the name of an attribute of the node itself, such as `self.busy`; empty if it is something else."""
    own = isinstance(node, ast.Attribute) and unparse(node.value) == "self"
    return unparse(node) if own else ""


def _constant(value: ast.expr) -> object:
    return value.value if isinstance(value, ast.Constant) else value


def _refusals(statements: list[ast.stmt]) -> list[int]:
    """Return the lines that return REJECT in statements and all that is in them."""
    nodes = (node for each in statements for node in walk(each))
    return [node.lineno for node in nodes if isinstance(node, ast.Return) and node.value and _rejects(node.value)]


def _rejects(value: ast.expr) -> bool:
    return any(isinstance(each, ast.Attribute) and each.attr == "REJECT" for each in walk(value))


def _judges(tree: ast.AST) -> Iterator[ast.FunctionDef]:
    """Yield the functions with a goal that answer to it."""
    for function in functions(tree):
        if "goal_handle" not in {each.arg for each in function.args.args} and _refusals(function.body):
            yield function


@suspicion_of(About.REFUSES_CANCEL)
def cancellations_refused(tree: ast.AST) -> Words:
    """Find a cancel callback that refuses."""
    for function in (each for each in functions(tree) if each.name in _given_to_cancel(tree)):
        for node in nodes_of(function, ast.Return):
            if node.value is not None and _rejects(node.value):
                yield node, f"`{unparse(node)[:90]}` in {function.name} refuses"


@suspicion_of(About.QUEUED)
def waits_for_its_turn(tree: ast.AST) -> Words:
    """Find a goal that waits in execute until the patrol before it has ended: for a lock, or for a flag of the node."""
    given = [
        each.value
        for call, name in calls(tree)
        if name == "ActionServer"
        for each in [*call.keywords, *(ast.keyword("execute_callback", arg) for arg in call.args[3:4])]
        if each.arg == "execute_callback"
    ]
    names = {last_name(each) for each in given}
    locks = {_own(t) for t, v in assigned(tree) if isinstance(v, ast.Call) and last_name(v.func) in TURNS}
    for function in (each for each in functions(tree) if each.name in names):
        for line, what in _waits(function, locks - {""}):
            yield (
                line,
                f"a goal waits here for {what} until the one before it has ended; one patrol at a time means that "
                "goal_callback returns GoalResponse.REJECT meanwhile",
            )


@suspicion_of(About.REFUSES_ALL)
def set_before_the_answer(tree: ast.AST) -> Words:
    """Find a flag that refuses goals and is set before other tests, which may still refuse this one."""
    for function in _judges(tree):
        tested = {
            _own(each): node.lineno
            for node in nodes_of(function, ast.If)
            if _refusals(node.body)
            for each in nodes_of(node.test, ast.expr)
            if _own(each)
        }
        for number, statement in enumerate(function.body):
            for target, value in assigned(statement) if isinstance(statement, ast.Assign) else ():
                name, later = _own(target), _refusals(function.body[number + 1 :])
                if _constant(value) is True and name in tested and later:
                    yield (
                        statement,
                        f"{name} is set before line {later[0]} rejects a goal, so a rejected goal leaves the server "
                        "busy, too, and nothing ends it: set the flag right before return GoalResponse.ACCEPT",
                    )


def _reads(tree: ast.AST) -> Iterator[ast.expr]:
    for node in nodes_of(tree, ast.Attribute):
        if isinstance(node.ctx, ast.Load) and _own(node):
            yield node


def _given_to_cancel(tree: ast.AST) -> list[str]:
    """Return the names of the functions that answer whether a goal may be cancelled."""
    return [
        last_name(each.value)
        for call, name in calls(tree)
        if name == "ActionServer"
        for each in call.keywords
        if each.arg == "cancel_callback"
    ]


@suspicion_of(About.REFUSES_ALL)
def locked_before_the_answer(tree: ast.AST) -> Words:
    """Find a lock that is taken in a test of a goal, before other tests that may still refuse it."""
    for function in _judges(tree):
        for number, statement in enumerate(function.body):
            taken = [
                each.func.value
                for each in (walk(statement.test) if isinstance(statement, ast.If) else ())
                if isinstance(each, ast.Call) and isinstance(each.func, ast.Attribute) and each.func.attr == "acquire"
            ]
            later = _refusals(function.body[number + 1 :])
            released = "release" in {name for part in function.body for name in called(part)}
            if taken and later and not released:
                name = unparse(taken[0])
                yield (
                    statement,
                    f"{name} is acquired before line {later[0]} rejects a goal, and nothing releases it then, so every "
                    "goal after a rejected one is refused, too: acquire it last, right before GoalResponse.ACCEPT",
                )


@suspicion_of(About.STORED_GOAL)
def kept_of_refused_goals(tree: ast.AST) -> Words:
    """Find what is kept of a goal before it is refused, where another function uses it."""
    for function in _judges(tree):
        goal = function.args.args[-1].arg
        used = {_own(n) for f in functions(tree) if f is not function for n in _reads(f)}
        for number, statement in enumerate(function.body):
            later = _refusals(function.body[number + 1 :])
            for target, value in assigned(statement) if isinstance(statement, ast.Assign) else ():
                of_goal = any(isinstance(each, ast.Name) and each.id == goal for each in walk(value))
                if later and of_goal and _own(target) in used:
                    yield (
                        statement,
                        f"{_own(target)} is set by every goal that comes, also by one that line {later[-1]} rejects: "
                        "take it from goal_handle.request where a goal is executed",
                    )


@suspicion_of(About.ANEW)
def cancelled_for_ever(tree: ast.AST) -> Words:
    """Find a flag that the cancel callback sets and that nothing sets back."""
    for function in (each for each in functions(tree) if each.name in _given_to_cancel(tree)):
        for target, value in assigned(function):
            name = _own(target)
            others = [f for f in functions(tree) if f is not function and f.name != "__init__"]
            back = any(_own(t) == name for f in others for t, _ in assigned(f))
            asked = any(_own(each) == name for f in others for each in _reads(f))
            if name and _constant(value) is True and asked and not back:
                yield (
                    target,
                    f"{name} becomes True with the first cancellation and stays so, so every later goal counts as "
                    "cancelled: ask goal_handle.is_cancel_requested, which each goal has for itself, or set it to "
                    "False where a goal is executed",
                )


@suspicion_of(About.ANEW)
def events_never_cleared(tree: ast.AST) -> Words:
    """Find an Event of the node that a goal waits for, and that nothing clears for the next goal."""
    if "ActionServer" not in called(tree):
        return
    made: dict[str, list[str]] = {}
    for function in functions(tree):
        for target, value in assigned(function):
            if isinstance(value, ast.Call) and last_name(value.func) == "Event" and _own(target):
                made.setdefault(_own(target), []).append(function.name)
    used: dict[str, dict[str, int]] = {}
    for call, name in calls(tree):
        if isinstance(call.func, ast.Attribute) and _own(call.func.value):
            used.setdefault(_own(call.func.value), {})[name] = call.lineno
    for name, where in made.items():
        does = used.get(name, {})
        if where == ["__init__"] and {"wait", "set"} <= does.keys() and "clear" not in does:
            yield (
                does["wait"],
                f"{name} stays set from the first goal on, so wait() returns at once for every later goal: call "
                f"{name}.clear() where a goal is executed",
            )


@suspicion_of(About.CANCEL)
def active_is_not_cancelled(tree: ast.AST) -> Words:
    """Find a loop that asks is_active, in a file that never asks whether a goal is to be cancelled."""
    asked = [each for each in nodes_of(tree, ast.Attribute)]
    if any(each.attr == "is_cancel_requested" for each in asked):
        return
    for each in asked:
        if each.attr == "is_active":
            yield (
                each,
                f"{unparse(each)} stays True until the goal is ended here, also while somebody waits for it to be "
                f"cancelled: ask {unparse(each.value)}.is_cancel_requested",
            )


@suspicion_of(About.ENDED, ast.FunctionDef)
def aborts_at_the_end(function: ast.FunctionDef) -> Words:
    """Find abort() as the last end of a goal, in a function that never calls succeed()."""
    ends = [(call, name) for call, name in calls(function) if name in ENDS and not call.args]
    if not ends or any(name == "succeed" for _, name in ends):
        return
    for statement in function.body:
        call = statement.value if isinstance(statement, ast.Expr) else None
        if isinstance(call, ast.Call) and last_name(call.func) == "abort":
            yield (
                call,
                f"{unparse(call)} says that the goal failed; "
                f"{unparse(call.func).rpartition('.')[0]}.succeed() ends one that was done",
            )


def _waits(function: ast.FunctionDef, locks: set[str]) -> Iterator[tuple[int, str]]:
    """Yield each place at which a function takes a lock for all that it does, or sleeps until a flag is set back."""
    for number, statement in enumerate(function.body):
        driven = any(isinstance(each, ast.For | ast.While) for last in function.body[:number] for each in walk(last))
        if isinstance(statement, ast.With):
            for item in statement.items:
                held = unparse(item.context_expr)
                if held in locks and not driven and any(isinstance(each, ast.Return) for each in walk(statement)):
                    yield statement.lineno, held
        call = statement.value if isinstance(statement, ast.Expr) else None
        held = unparse(call.func).removesuffix(".acquire") if isinstance(call, ast.Call) else ""
        if held in locks:
            yield statement.lineno, held
        if isinstance(statement, ast.While) and called(statement) <= {"sleep", "ok"} and "sleep" in called(statement):
            flag = next((_own(each) for each in _reads(statement.test)), "")
            set_later = any(_own(t) == flag and _constant(v) is True for t, v in assigned(function))
            if flag and set_later:
                yield statement.lineno, flag


@suspicion_of(About.NO_FEEDBACK)
def feedback_never_sent(tree: ast.AST) -> Words:
    """Find an action server in a file without publish_feedback()."""
    if any(each.attr == "publish_feedback" for each in nodes_of(tree, ast.Attribute)):
        return
    for call, name in calls(tree):
        if name == "ActionServer":
            yield call, "the execute callback of this action server never calls publish_feedback()"
