"""Mistakes of the first days: brackets, commas, quotes, indentation, periods of timers, callbacks that block."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.constants import named_numbers, number
from gz_course.grader.feedback.facts.syntax import Place, Words, calls, functions, last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.slips import LONGEST_PERIOD, Run, slip, slip_of, slip_of_run
from gz_course.grader.feedback.slips.nodes.callbacks import handed_over

BEFORE = ("conditions",)

ACTIONS = frozenset({
    "cancel", "publish", "spin", "init", "shutdown", "destroy_node", "reset", "succeed", "canceled", "abort",
    "publish_feedback", "clear", "append", "popleft",
})  # fmt: skip
TRANSFORM = {"lookup_transform": 3, "can_transform": 3, "transform": 2}  # method of a Buffer -> position of its timeout
CLOCKS = frozenset({"now", "time", "monotonic", "perf_counter"})  # asked by a loop that waits for time to pass
WAITING = frozenset({"ok", "now", "get_clock", "publish", "info", "print"})
MESSAGE_FIELDS = frozenset({"data", "x", "y", "z", "w"})


@slip_of(ast.ClassDef)
def constructors(each: ast.ClassDef) -> Words:
    for node in each.body:
        wrong = isinstance(node, ast.FunctionDef) and node.name.strip("_") in ("init", "int", "ini")
        if isinstance(node, ast.FunctionDef) and wrong and node.name.startswith("_") and node.name != "__init__":
            yield (
                node,
                f"the method {node.name} is never called: the constructor is __init__, with two underscores on "
                "either side",
            )


@slip
def main_not_called(tree: ast.Module) -> Iterator[Place]:
    """Find a function main that no code of the module calls."""
    main = next((node for node in tree.body if isinstance(node, ast.FunctionDef) and node.name == "main"), None)
    if main is None:
        return
    outside = [node for node in tree.body if node is not main]
    if not any(name == "main" for part in outside for _, name in calls(part)):
        yield (
            main.lineno,
            "main() is defined, but nothing calls it: the file ends with  if __name__ == '__main__': main()",
        )


@slip
def not_called(tree: ast.AST) -> Iterator[Place]:
    """Find a statement that only names a function, such as `self.timer.cancel`, or a method of the file."""
    own = {f"self.{function.name}" for function in functions(tree) if not function.decorator_list}
    for node in nodes_of(tree, ast.Expr):
        if isinstance(node.value, ast.Attribute | ast.Name):
            name = unparse(node.value)
            if name.rpartition(".")[2] in ACTIONS | {"main"} or name in own:
                yield node.lineno, f"{name} without brackets names the function and does not call it: {name}(...)"


@slip_of_run
def periods(tree: ast.AST, run: Run) -> Iterator[Place]:
    """Find a timer whose period [s] is longer than the run, or 0 because whole numbers were divided."""
    known, longest = named_numbers(tree), run.duration
    for call, name in calls(tree):
        given = (
            call.args[0] if call.args else next((k.value for k in call.keywords if k.arg == "timer_period_sec"), None)
        )
        period = number(given, known)
        if name != "create_timer" or period is None or given is None:
            continue
        code = unparse(given)
        value = f"{code}, which is {period:g}," if not isinstance(given, ast.Constant) else f"{code},"
        if period >= LONGEST_PERIOD:
            yield (
                call.lineno,
                f"the timer's period is in seconds: create_timer({value} ...) fires for the first time after "
                f"{period / 60:.0f} minutes; {period:g} ms are {period / 1000:g}",
            )
        elif period > longest:
            yield (
                call.lineno,
                f"the timer's period is in seconds: create_timer({value} ...) fires for the first time after "
                f"{period:g} s, when the run of {longest:g} s is over; {period:g} ms are {period / 1000:g}, and "
                f"{period:g} times per second are create_timer({1 / period:g}, ...)",
            )
        elif period == 0 and "//" in code:
            yield call.lineno, f"{code} is 0, because // leaves out the fraction: / divides numbers"


@slip
def decimal_commas(tree: ast.AST) -> Iterator[Place]:
    for node in walk(tree):
        values: list[ast.expr] = []
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Tuple) and len(node.targets) == 1:
            bare = node.value.col_offset == node.value.elts[0].col_offset if node.value.elts else False  # no brackets
            values = node.value.elts if bare and isinstance(node.targets[0], ast.Name | ast.Attribute) else []
        elif isinstance(node, ast.Call) and unparse(node.func).endswith("create_timer") and len(node.args) >= 3:
            values = node.args[:2]
        if _two_whole(values):
            yield values[0].lineno, _comma(values)


@slip
def sets_for_numbers(tree: ast.AST) -> Iterator[Place]:
    """Find `{x}` where a number or a text belongs: braces make a set outside of an f-string."""
    for node in walk(tree):
        values: list[ast.expr] = []
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Attribute):
            values = [node.value] if node.targets[0].attr in MESSAGE_FIELDS else []
        elif isinstance(node, ast.Call):
            values = [each.value for each in node.keywords if each.arg in MESSAGE_FIELDS]
        for value in values:
            if isinstance(value, ast.Set) and len(value.elts) == 1:
                inside = unparse(value.elts[0])
                yield value.lineno, f"{{{inside}}} is a set with one element, not its value: write {inside}"


def _two_whole(values: list[ast.expr]) -> bool:
    return len(values) == 2 and all(isinstance(v, ast.Constant) and isinstance(v.value, int) for v in values)


def _comma(values: list[ast.expr]) -> str:
    ahead, behind = (unparse(value) for value in values)
    return f"{ahead}, {behind} are two numbers: Python writes the decimal point as a point, {ahead}.{behind}"


@slip_of(ast.Call)
def strings_with_braces(call: ast.Call) -> Words:
    """Find a text with `{name}` in it that lacks the f before its quotes, where it is logged or published."""
    name = last_name(call.func)
    if name not in ("info", "warn", "warning", "error", "String"):
        return
    for value in [*call.args, *(each.value for each in call.keywords)]:
        text = value.value if isinstance(value, ast.Constant) else ""
        if isinstance(text, str) and "{" in text and "}" in text[text.index("{") :]:
            yield value, "this text holds {...} but has no f before its quotes, so it is sent as it stands"


@slip_of(ast.Attribute)
def strengths(node: ast.Attribute) -> Words:
    if node.attr == "intensities":
        yield "intensities are how strong the echoes are; how far the points are [m] is in ranges"


@slip
def stray_methods(tree: ast.AST) -> Iterator[Place]:
    """Find a function with the parameter self that stands outside of a class, because of its indentation."""
    owned = {id(node) for each in nodes_of(tree, ast.ClassDef) for node in each.body}
    for node in nodes_of(tree, ast.FunctionDef):
        if id(node) in owned or node.decorator_list:
            continue
        if [each.arg for each in node.args.args[:1]] == ["self"]:
            yield (
                node.lineno,
                f"{node.name}(self, ...) is no method of the class: by its indentation it stands outside of the class, "
                "or inside of another method",
            )


@slip
def blocking(tree: ast.AST) -> Iterator[Place]:
    """Find an endless loop, or a Rate, inside a callback: while it runs, no other callback and no clock does."""
    handed = {
        unparse(given).rpartition(".")[2]
        for call, given in handed_over(tree)
        if unparse(call.func).endswith((".create_timer", ".create_subscription"))
    }
    for node in nodes_of(tree, ast.FunctionDef):
        if node.name not in handed:
            continue
        rates = [call for call, name in calls(node) if name == "create_rate"]
        for inner in nodes_of(node, ast.While):
            names = {name for _, name in calls(inner)}
            if names & {"spin_once", "spin_some"}:
                continue
            endless = isinstance(inner.test, ast.Constant) and not any(
                isinstance(each, ast.Break | ast.Return | ast.Raise) for each in walk(inner)
            )
            asked = {name for _, name in calls(inner.test)}
            if rates or endless or "sleep" in names or asked & CLOCKS or (names and not names - WAITING):
                yield (
                    inner.lineno,
                    f"the loop in the callback {node.name} keeps the executor: while it runs, no other callback and no "
                    "clock does. A timer calls a function again and again; return from it each time",
                )


@slip
def waits_for_transforms(tree: ast.AST) -> Iterator[Place]:
    """Find a lookup with a timeout in a node with a single thread: no transform is heard while it waits."""
    threads = any(
        name in ("MultiThreadedExecutor", "Thread") or "spin_thread" in [each.arg for each in call.keywords]
        for call, name in calls(tree)
    )
    if threads:
        return
    for call, name in calls(tree):
        given = [*call.args[TRANSFORM.get(name, 0) :], *(each for each in call.keywords if each.arg == "timeout")]
        if name in TRANSFORM and given:
            yield (
                call.lineno,
                f"{name}() with a timeout keeps the only thread of the node: no transform is heard while it waits. "
                "Leave the timeout out, and try again later",
            )


@slip
def long_sleeps(tree: ast.AST) -> Iterator[Place]:
    """Find a sleep of minutes with a publish() behind it in its block, which hardly waits for that."""
    known = named_numbers(tree)
    for block in (node.body for node in nodes_of(tree, ast.Module, ast.FunctionDef)):
        for place, statement in enumerate(block):
            call = statement.value if isinstance(statement, ast.Expr) else None
            if not isinstance(call, ast.Call) or last_name(call.func) != "sleep" or not call.args:
                continue
            seconds = number(call.args[0], known)
            published = any(name == "publish" for behind in block[place:] for _, name in calls(behind))
            if seconds is not None and seconds >= LONGEST_PERIOD and published:
                yield (
                    call.lineno,
                    f"{unparse(call)} takes seconds: what follows runs only after {seconds / 60:.0f} minutes; "
                    f"{seconds:g} ms are {seconds / 1000:g}",
                )
