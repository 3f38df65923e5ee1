"""Suspects in how an action server takes goals: what it refuses or accepts, how it ends one, what it keeps of it."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.constants import named_numbers, number
from gz_course.grader.feedback.facts.syntax import (
    Words,
    assigned,
    called,
    calls,
    functions,
    is_none,
    last_name,
    nodes_of,
    unparse,
    walk,
)
from gz_course.grader.feedback.suspects import suspicion, suspicion_of
from gz_course.grader.feedback.suspects.about import About, Suspect

ASKS = "is_cancel_requested"
# Comparisons of a length with a number that tell an empty list from all others.
TELLS_EMPTY = frozenset({(ast.Eq, 0), (ast.NotEq, 0), (ast.Gt, 0), (ast.LtE, 0), (ast.Lt, 1), (ast.GtE, 1)})
GROWS = frozenset({"append", "extend", "appendleft"})
EMPTIES = frozenset({"clear", "pop", "popleft", "remove"})
LIMIT = "max_speed"


def _answers(function: ast.FunctionDef) -> tuple[str, str] | None:
    """Return what a function returns where a goal is to be cancelled, and otherwise; None if that is the same."""
    asked = [
        each for each in nodes_of(function, ast.If) if ASKS in unparse(each.test)
    ]  # fmt: skip
    inside = [part for each in asked for part in each.body if isinstance(part, ast.Return)]
    others = [each for each in nodes_of(function, ast.Return) if each not in inside]
    if not inside or inside[0].value is None:
        return None
    then = unparse(inside[0].value)
    otherwise = [unparse(each.value) for each in others if each.value is not None]
    constant = isinstance(inside[0].value, ast.Constant)
    return (then, otherwise[0]) if constant and otherwise and then != otherwise[0] else None


@suspicion_of(About.CANCEL, ast.FunctionDef)
def answers_thrown_away(function: ast.FunctionDef, tree: ast.AST) -> Words:
    """Find `self.drive_to(point)` as a statement, where drive_to returns whether the goal was cancelled."""
    answer = _answers(function)
    if answer is None:
        return
    for node in walk(tree):
        call = node.value if isinstance(node, ast.Expr) else None
        if isinstance(call, ast.Call) and last_name(call.func) == function.name:
            yield (
                call,
                f"{unparse(call.func)}() returns {answer[0]} when the goal is to be cancelled, and this line "
                "throws that away, so execute goes on as if the waypoint were reached: ask what it returns, and "
                "end the patrol there",
            )


def _judges(tree: ast.AST) -> Iterator[ast.FunctionDef]:
    """Yield the functions that answer to goals."""
    for function in functions(tree):
        if any(isinstance(each, ast.Attribute) and each.attr in ("REJECT", "ACCEPT") for each in walk(function)):
            yield function


@suspicion_of(About.GOAL_LENGTH)
def short_lists_refused(tree: ast.AST) -> Words:
    """Find a length that is compared with another number than the one that tells an empty list."""
    for function in _judges(tree):
        for node in nodes_of(function, ast.Compare):
            if len(node.ops) != 1 or not isinstance(node.left, ast.Call):
                continue
            limit = node.comparators[0]
            number = limit.value if isinstance(limit, ast.Constant) else None
            if unparse(node.left.func) != "len" or not isinstance(number, int):
                continue
            if (type(node.ops[0]), number) not in TELLS_EMPTY:
                what = unparse(node.left.args[0]).rpartition(".")[2] if node.left.args else "the list"
                yield (
                    node,
                    f"`{unparse(node)}` refuses goals by the number of their {what}, and not only empty ones: "
                    "a goal with one is a goal, too",
                )


@suspicion_of(About.GOAL_LIMIT)
def limits_excluded(tree: ast.AST) -> Words:
    """Find an answer to a goal by which a speed that is the limit itself is too much."""
    for function in _judges(tree):
        for test in nodes_of(function, ast.If, ast.IfExp):
            body = " ".join(unparse(each) for each in (test.body if isinstance(test, ast.If) else [test.body]))
            refuses = "REJECT" in body
            if refuses == ("ACCEPT" in body):
                continue
            for compare, turned in _compares(test.test, False):
                if _excludes(compare, refuses != turned):
                    yield (
                        compare,
                        f"by `{unparse(compare)}`, a speed that is max_speed itself is refused: only one above it "
                        "is too fast",
                    )


def _compares(node: ast.AST, turned: bool) -> Iterator[tuple[ast.Compare, bool]]:
    """Yield the comparisons of a condition, and whether a `not` stands before each."""
    if isinstance(node, ast.Compare):
        yield node, turned
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
        yield from _compares(node.operand, not turned)
    elif isinstance(node, ast.BoolOp):
        for each in node.values:
            yield from _compares(each, turned)


def _excludes(compare: ast.Compare, refuses: bool) -> bool:
    """Return whether a comparison with an upper limit refuses the limit itself."""
    sides = [compare.left, *compare.comparators]
    for left, op, right in zip(sides, compare.ops, sides[1:], strict=False):
        speed_first, speed_last = _is_speed(left), _is_speed(right)
        limit = right if speed_first else left
        if speed_first == speed_last or isinstance(limit, ast.Constant | ast.UnaryOp):
            continue
        strict_above = ast.Lt if speed_first else ast.Gt  # speed < limit: what is accepted by it leaves the limit out
        wide_above = ast.GtE if speed_first else ast.LtE  # speed >= limit: what is refused by it takes the limit in
        if isinstance(op, wide_above if refuses else strict_above):
            return True
    return False


def _is_speed(node: ast.expr) -> bool:
    return isinstance(node, ast.Attribute) and node.attr == "speed"


@suspicion_of(About.CANCEL, ast.If)
def aborted_when_cancelled(test: ast.If) -> Words:
    """Find abort() where a cancellation was asked for."""
    if "is_cancel_requested" not in unparse(test.test):
        return
    for call in (each for part in test.body for each in nodes_of(part, ast.Call)):
        if isinstance(call.func, ast.Attribute) and call.func.attr == "abort":
            yield call, f"{unparse(call)} ends the goal as ABORTED; {unparse(call.func.value)}.canceled() belongs here"


def _fields(tree: ast.AST) -> list[tuple[ast.expr, str | None]]:
    """Return what is given to fields of messages, by keyword or by assignment, with the name of the field."""
    given = [(each.value, each.arg) for each in nodes_of(tree, ast.keyword)]
    return given + [(value, target.attr) for target, value in assigned(tree) if isinstance(target, ast.Attribute)]


@suspicion_of(About.FEEDBACK)
def whole_distances(tree: ast.AST) -> Words:
    """Find a distance of a feedback that is made a whole number, where the field is a float."""
    for value, field in _fields(tree):
        name = last_name(value.func) if isinstance(value, ast.Call) else ""
        if field == "distance" and isinstance(value, ast.Call) and len(value.args) == 1 and name in ("round", "int"):
            yield (
                value,
                f"{unparse(value)} is a whole number, and the field distance is a float64, to which rclpy does "
                "not convert it: the number itself, or float(...), can be sent",
            )


@suspicion
def broken_indices(tree: ast.AST) -> Iterator[Suspect]:
    """Find an index of a feedback that is a quotient or is made a float, where the field is an int32."""
    for value, field in _fields(tree):
        quotient = isinstance(value, ast.BinOp) and isinstance(value.op, ast.Div)
        broken = quotient or (isinstance(value, ast.Call) and last_name(value.func) == "float")
        if field in ("waypoint", "visited") and broken:
            yield (
                value.lineno,
                About.FEEDBACK if field == "waypoint" else About.UNSENT_RESULT,
                f"{unparse(value)} is a float, and the field {field} is an int32, which rclpy cannot send it as: "
                "give it a whole number",
            )
        elif field == "waypoint" and isinstance(value, ast.Name) and _has_coordinates(tree, value.id):
            yield (
                value.lineno,
                About.FEEDBACK,
                f"{value.id} is a point, and the field waypoint of the feedback is an int32: the index of the waypoint",
            )


def _has_coordinates(tree: ast.AST, name: str) -> bool:
    """Return whether x and y of something are read."""
    read = {unparse(each) for each in nodes_of(tree, ast.Attribute)}
    return {f"{name}.x", f"{name}.y"} <= read


def _kept(tree: ast.AST) -> Iterator[tuple[ast.FunctionDef, dict[str, str]]]:
    """Yield each function that ends goals, with the attributes that `__init__` alone assigns, and what."""
    assigned: dict[str, list[tuple[str, str]]] = {}
    for function in functions(tree):
        for node in nodes_of(function, ast.Assign):
            for target in node.targets:
                for each in nodes_of(target, ast.Attribute):
                    if isinstance(each.ctx, ast.Store):
                        assigned.setdefault(unparse(each), []).append((function.name, unparse(node.value)))
    once = {name: where[0][1] for name, where in assigned.items() if [each for each, _ in where] == ["__init__"]}
    for function in functions(tree):
        if "succeed" in called(function):
            yield function, {name: value for name, value in once.items() if name.startswith("self.")}


@suspicion_of(About.ANEW)
def lists_that_grow(tree: ast.AST) -> Words:
    """Find a list of the node that every goal makes longer, and that nothing empties."""
    for function, once in _kept(tree):
        for name in (each for each, value in once.items() if value in ("[]", "list()", "deque()")):
            uses = [
                (call.func.attr, call.lineno)
                for call in nodes_of(tree, ast.Call)
                if isinstance(call.func, ast.Attribute) and unparse(call.func.value) == name
            ]
            inside = range(function.lineno, (function.end_lineno or function.lineno) + 1)
            grows = [line for method, line in uses if method in GROWS and line in inside]
            deleted = any(isinstance(each, ast.Delete) and name in unparse(each) for each in walk(tree))
            if grows and not deleted and not any(method in EMPTIES for method, _ in uses):
                yield (
                    grows[0],
                    f"{name} keeps what earlier goals have put into it, and this line adds to it: make a new one where "
                    "a goal is executed",
                )


@suspicion_of(About.ANEW)
def counters_that_go_on(tree: ast.AST) -> Words:
    """Find the index of a waypoint that goes on from goal to goal."""
    for function, once in _kept(tree):
        for node in nodes_of(function, ast.AugAssign):
            name = unparse(node.target)
            indexes = any(isinstance(each, ast.Subscript) and unparse(each.slice) == name for each in walk(function))
            if once.get(name, "").lstrip("-").isdigit() and indexes:
                yield (
                    node,
                    f"{name} is {once[name]} for the first goal only, and goes on from there for the next one: set it "
                    f"to {once[name]} where a goal is executed",
                )


def _answering(tree: ast.AST) -> Iterator[ast.FunctionDef]:
    """Yield the functions that answer to goals."""
    for function in functions(tree):
        if any(unparse(each).endswith(("Response.REJECT", "Response.ACCEPT")) for each in _attributes(function)):
            yield function


def _attributes(tree: ast.AST) -> tuple[ast.Attribute, ...]:
    return nodes_of(tree, ast.Attribute)


@suspicion_of(About.ACCEPTS_ALL, ast.Call)
def never_refuses(call: ast.Call, tree: ast.AST) -> Words:
    """Find a goal callback that knows no answer but ACCEPT."""
    name = last_name(call.func)
    given = next((each.value for each in call.keywords if each.arg == "goal_callback"), None)
    if name != "ActionServer" or given is None:
        return
    for function in (each for each in _answering(tree) if each.name == last_name(given)):
        answers = {each.attr for each in _attributes(function)}
        if "ACCEPT" in answers and "REJECT" not in answers:
            yield function, f"{function.name} knows no answer but GoalResponse.ACCEPT"


@suspicion_of(About.ACCEPTS_EMPTY)
def lists_are_never_none(tree: ast.AST) -> Words:
    """Find a goal without waypoints that is looked for by None."""
    for function in _answering(tree):
        for node in nodes_of(function, ast.Compare):
            other = node.comparators[0]
            if last_name(node.left) == "waypoints" and is_none(other):
                yield (
                    node,
                    f"waypoints of a goal is a list, never None, so `{unparse(node)}` is always the same: a goal "
                    f"without waypoints has an empty list, `len({unparse(node.left)}) == 0`",
                )


@suspicion_of(About.ACCEPTS_BACKWARDS)
def signs_taken_away(tree: ast.AST) -> Words:
    """Find abs(speed) in an answer to a goal."""
    for function in _answering(tree):
        for call, name in calls(function):
            if name in ("abs", "fabs") and call.args and last_name(call.args[0]) == "speed":
                yield call, f"{unparse(call)} has no sign any more, so a negative speed counts as a positive one"


@suspicion_of(About.OTHER_LIMIT)
def limits_that_are_no_parameter(tree: ast.AST) -> Words:
    """Find a speed of a goal that is compared with a constant, and a parameter for its limit of another name."""
    declared = [
        (call.lineno, str(call.args[0].value))
        for call, name in calls(tree)
        if name == "declare_parameter" and call.args and isinstance(call.args[0], ast.Constant)
    ]
    if declared and any(_answering(tree)) and LIMIT not in (name for _, name in declared):
        line, name = declared[0]
        yield line, f"the node has a parameter `{name}`, and the task calls the limit `{LIMIT}`"
    known = named_numbers(tree)
    for function in _answering(tree):
        own = {unparse(target): value for target, value in assigned(tree)}
        for node in nodes_of(function, ast.Compare):
            sides = [node.left, *node.comparators]
            if not any(last_name(each) == "speed" for each in sides):
                continue
            for side in sides:
                value = number(own.get(unparse(side), side), known)
                if value is not None and value > 0:
                    yield (
                        node,
                        f"`{unparse(node)[:70]}` takes the constant {value:g} for the limit: it is the parameter, "
                        f"self.get_parameter('{LIMIT}').value",
                    )
