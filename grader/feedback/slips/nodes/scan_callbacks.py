"""What a callback of a scan or a timer should not do."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Place, Words, calls, functions, kept, left_early, nodes_of, unparse
from gz_course.grader.feedback.slips import slip, slip_of

LONG = 0.05  # [s] of sleep; data come 10 times a second and faster
ASKS_FOR_INVALID = ("isinf", "isnan", "isfinite", "range_max", "range_min", "inf", "nan")


def callbacks(tree: ast.AST, methods: tuple[str, ...] = ("create_timer", "create_subscription")) -> set[str]:
    """Return the names of functions that are passed to timers and subscriptions."""
    return {name for method, name in _handed(tree) if method in methods}


@kept
def _handed(tree: ast.AST) -> frozenset[tuple[str, str]]:
    found = set()
    for call, _ in calls(tree):
        method = unparse(call.func).rpartition(".")[2]
        place = {"create_timer": 1, "create_subscription": 2}.get(method)
        given = call.args[place] if place is not None and len(call.args) > place else None
        given = next((each.value for each in call.keywords if each.arg == "callback" and place), given)
        if given is not None:
            found.add((method, unparse(given).rpartition(".")[2]))
    return frozenset(found)


@slip_of(ast.For, first=True)
def ended_by_an_invalid_ray(loop: ast.For) -> Words:
    """Find `return` or `break` in a loop over all rays where a ray is not valid: the rays behind it are lost."""
    if ".ranges" not in unparse(loop.iter):
        return
    for node in (each for each in loop.body if isinstance(each, ast.If) and len(each.body) == 1):
        leaves = node.body[0]
        ends = isinstance(leaves, ast.Break) or (isinstance(leaves, ast.Return) and leaves.value is None)
        text = unparse(node.test)
        invalid = re.search(
            r"not (?:\w+\.)?isfinite\(|(?<!not )(?<!not math\.)(?<!not np\.)\b(?:isinf|isnan)\(|== .*inf", text
        )
        if ends and invalid and "enumerate" not in text and not node.orelse and len(loop.body) > 1:
            yield (
                leaves,
                f"{unparse(leaves)} ends the whole loop over the rays at the first one that is not valid, so "
                "the rays behind it are left out: continue goes on with the next ray",
            )


@slip
def sleeping(tree: ast.AST) -> Iterator[Place]:
    """Find a callback of a subscription that sleeps."""
    handed = callbacks(tree, ("create_subscription",))
    for function in (each for each in functions(tree) if each.name in handed):
        for call, _ in calls(function):
            value = call.args[0].value if call.args and isinstance(call.args[0], ast.Constant) else None
            if unparse(call.func) in ("time.sleep", "sleep") and isinstance(value, int | float) and value >= LONG:
                yield (
                    call.lineno,
                    f"{unparse(call)} in the callback {function.name}: while it sleeps, the node takes no other "
                    "message, and those that come meanwhile are late or lost",
                )


@slip_of(ast.FunctionDef)
def kept_defaults(function: ast.FunctionDef) -> Words:
    """Find a list that is the default of a parameter, and is added to."""
    arguments, defaults = function.args.args, function.args.defaults
    for argument, default in zip(arguments[len(arguments) - len(defaults) :], defaults, strict=True):
        names = [node for node in nodes_of(function, ast.AugAssign, ast.Assign)]
        anew = any(argument.arg in map(unparse, node.targets) for node in names if isinstance(node, ast.Assign))
        if not isinstance(default, ast.List | ast.Dict) or anew:
            continue
        grows = any(unparse(node.target) == argument.arg for node in names if isinstance(node, ast.AugAssign))
        added = {f"{argument.arg}.append", f"{argument.arg}.extend", f"{argument.arg}.update"}
        calls = {unparse(node.func) for node in nodes_of(function, ast.Call)}
        if calls & added or grows:
            yield (
                f"the default of {argument.arg} is made once, when {function.name} is defined: what is added stays "
                "in it from call to call; make a new list inside"
            )


@slip_of(ast.FunctionDef)
def one_ray_skips_the_scan(function: ast.FunctionDef) -> Words:
    """Find a callback that returns if any ray is not valid."""
    for node in nodes_of(function, ast.If):
        if not isinstance(node.body[-1], ast.Return) or node.orelse:
            continue
        text = unparse(node.test)
        of_all = text.startswith(("any(", "not all(", "np.any(", "not np.all(")) or " in " in text.partition("(")[0]
        if of_all and ".ranges" in text and any(word in text for word in ASKS_FOR_INVALID):
            yield (
                node,
                "a single ray that is not valid makes this return, and nearly every scan has one: leave out the "
                "ray, not the scan",
            )


@slip_of(ast.FunctionDef)
def published_for_each_ray(function: ast.FunctionDef) -> Words:
    """Find publish() within a loop over the rays of a scan."""
    rays = {
        unparse(node.targets[0])
        for node in nodes_of(function, ast.Assign)
        if isinstance(node.value, ast.ListComp | ast.GeneratorExp) and ".ranges" in unparse(node.value)
    }
    for loop in nodes_of(function, ast.For):
        over = unparse(loop.iter)
        if ".ranges" not in over and over not in rays:
            continue
        if left_early(loop):
            continue
        for call, _ in calls(loop):
            if unparse(call.func).endswith(".publish"):
                yield (
                    call,
                    f"publish() stands in the loop over the rays, line {loop.lineno}, and may publish for each of "
                    "them: by its indentation it belongs after the loop",
                )
                break
