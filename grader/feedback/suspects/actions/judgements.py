"""Suspects in what a callback accepts: tests of a goal that never refuse it, and a limit that is no parameter."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.constants import named_numbers, number
from gz_course.grader.feedback.facts.syntax import (
    Words,
    assigned,
    calls,
    functions,
    is_none,
    last_name,
    nodes_of,
    unparse,
)
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

LIMIT = "max_speed"


def _judges(tree: ast.AST) -> Iterator[ast.FunctionDef]:
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
    for function in (each for each in _judges(tree) if each.name == last_name(given)):
        answers = {each.attr for each in _attributes(function)}
        if "ACCEPT" in answers and "REJECT" not in answers:
            yield function, f"{function.name} knows no answer but GoalResponse.ACCEPT"


@suspicion_of(About.ACCEPTS_EMPTY)
def lists_are_never_none(tree: ast.AST) -> Words:
    """Find a goal without waypoints that is looked for by None."""
    for function in _judges(tree):
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
    for function in _judges(tree):
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
    if declared and any(_judges(tree)) and LIMIT not in (name for _, name in declared):
        line, name = declared[0]
        yield line, f"the node has a parameter `{name}`, and the task calls the limit `{LIMIT}`"
    known = named_numbers(tree)
    for function in _judges(tree):
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
