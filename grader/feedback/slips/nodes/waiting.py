"""Nodes that wait where nobody runs them: loops before spin(), a Rate without a thread, an executor without a node."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import (
    Place,
    Words,
    called,
    calls,
    functions,
    hands_over,
    left_early,
    nodes_of,
    unparse,
)
from gz_course.grader.feedback.slips import slip, slip_of
from gz_course.grader.feedback.slips.language.unreached import blocks

BEFORE = ("endless_waits",)

SPINS = frozenset(
    {"spin", "spin_once", "spin_some", "spin_until_future_complete", "wait_for_message", "wait_for_service"}
)
CLOCKS = frozenset({"now", "get_clock", "ok", "sleep", "get_subscription_count", "count_subscribers"})
PAUSE = 0.05  # [s] of sleep between two calls of spin_once
THREADS = frozenset({"Thread", "start_new_thread", "MultiThreadedExecutor", "ThreadPoolExecutor", "Process"})


@slip
def executors_never_spun(tree: ast.AST) -> Iterator[Place]:
    """Find an executor that gets nodes in a file where nothing spins."""
    spins = {name for name in called(tree) if name.startswith("spin")}
    for call, name in calls(tree):
        if name == "add_node" and isinstance(call.func, ast.Attribute) and not spins:
            executor = unparse(call.func.value)
            yield (
                call.lineno,
                f"{executor} gets a node here, but nothing lets it work: {executor}.spin() is missing after it",
            )


def _runs_before_spin(function: ast.FunctionDef, tree: ast.AST) -> bool:
    """Return whether a function is `__init__`, `main`, or a method that main calls and no timer does."""
    if function.name in ("__init__", "main"):
        return True
    text = f".{function.name}"
    handed = any(
        isinstance(node, ast.Attribute) and node.attr == function.name and isinstance(node.ctx, ast.Load)
        for call in nodes_of(tree, ast.Call)
        for node in [*call.args, *(each.value for each in call.keywords)]
    )
    mains = [node for node in nodes_of(tree, ast.FunctionDef) if node.name == "main"]
    return not handed and any(function.name in called(main) or text in unparse(main) for main in mains)


@slip
def another_executor_spins(tree: ast.AST) -> Iterator[Place]:
    """Find `rclpy.spin(node)` beside a MultiThreadedExecutor that got the node and is never spun itself."""
    made = {
        unparse(node.targets[0])
        for node in nodes_of(tree, ast.Assign)
        if "MultiThreadedExecutor(" in unparse(node.value)
    }
    code = [(call, unparse(call.func)) for call, _ in calls(tree)]
    for name in made:
        used = any(text.startswith(f"{name}.spin") for _, text in code)
        handed = any(name == unparse(each.value) for call, _ in code for each in call.keywords)
        handed |= any(name == unparse(each) for call, _ in code for each in call.args)
        for call, text in code:
            if text in ("rclpy.spin", "spin") and len(call.args) == 1 and not used and not handed and not call.keywords:
                yield (
                    call.lineno,
                    f"{unparse(call)} takes the node out of {name}, and spins it in one thread: the call is "
                    f"{name}.spin()",
                )
                return


@slip
def rates(tree: ast.AST) -> Iterator[Place]:
    """Find the sleep() of a Rate inside of a callback of a node with one thread."""
    if "create_rate" not in called(tree) or THREADS & called(tree):
        return
    rate = {unparse(node.targets[0]) for node in nodes_of(tree, ast.Assign) if "create_rate" in called(node.value)}
    for node in nodes_of(tree, ast.Call):
        if unparse(node.func) in {f"{name}.sleep" for name in rate}:
            yield (
                node.lineno,
                f"{unparse(node.func)}() waits for a timer of the node, which only another thread could run: it "
                "never returns. A timer, create_timer(PERIOD, callback), calls a function again and again",
            )
            return


@slip
def loops_before_spin(tree: ast.AST) -> Iterator[Place]:
    """Find an endless loop, or one that waits for the clock, in which nothing spins the node."""
    everything = called(tree)
    if everything & THREADS:
        return
    spinning = {function.name for function in functions(tree) if SPINS & called(function)}
    for function in [each for each in functions(tree) if _runs_before_spin(each, tree)]:
        for node in nodes_of(function, ast.While):
            inside = called(node)
            if inside & (SPINS | spinning) or hands_over(node):
                continue
            endless = (isinstance(node.test, ast.Constant) and bool(node.test.value)) or "ok" in called(node.test)
            if "create_rate" in everything and "sleep" in inside:
                line = next(call.lineno for call, _ in calls(node) if "sleep" in called(call))
                yield (
                    line,
                    "the sleep() of a Rate waits for a timer of the node, and nothing spins the node meanwhile: "
                    "it never returns. Let a timer call a function, create_timer(PERIOD, callback), and call "
                    "rclpy.spin(node)",
                )
                return
            if (endless and not left_early(node)) or (inside & CLOCKS - {"sleep"}):
                where = "__init__" if function.name == "__init__" else f"{function.name}()"
                yield (
                    node.lineno,
                    f"this loop in {where} runs before anything spins the node: meanwhile no timer, no callback and "
                    "not even its clock runs. Let a timer call a function again and again, and call rclpy.spin(node)",
                )
                return


@slip_of(ast.Assign)
def executors(node: ast.Assign, tree: ast.AST) -> Words:
    """Find an executor that is spun and was given no node."""
    if not isinstance(node.value, ast.Call):
        return
    name, kind = unparse(node.targets[0]), unparse(node.value.func).rpartition(".")[2]
    if kind not in ("SingleThreadedExecutor", "MultiThreadedExecutor"):
        return
    calls = [unparse(each.func) for each in nodes_of(tree, ast.Call)]
    handed = any(each.arg == "executor" for each in nodes_of(tree, ast.keyword))
    if f"{name}.spin" in calls and f"{name}.add_node" not in calls and not handed:
        yield f"{name} is spun, but no node is in it: {name}.add_node(node) comes before {name}.spin()"


@slip
def other_node(tree: ast.AST) -> Iterator[Place]:
    """Find a spin() of a new plain node, or of a second object of the class, beside the node that does the work."""
    classes = {
        node.name for node in nodes_of(tree, ast.ClassDef) if any(unparse(base).endswith("Node") for base in node.bases)
    }
    made = {
        unparse(node.targets[0]): unparse(node.value.func)
        for node in nodes_of(tree, ast.Assign)
        if isinstance(node.value, ast.Call)
    }
    for node in nodes_of(tree, ast.Call):
        if unparse(node.func) != "rclpy.spin" or not node.args:
            continue
        given = node.args[0]
        kind = unparse(given.func) if isinstance(given, ast.Call) else made.get(unparse(given), "")
        if classes and kind.rpartition(".")[2] in ("Node", "create_node"):
            yield (
                node.lineno,
                f"this spins a plain node of {kind}(...); the timers and callbacks are those of {sorted(classes)[0]}, "
                f"which nothing spins: rclpy.spin({sorted(classes)[0]}())",
            )
        if isinstance(given, ast.Call) and kind in classes and kind in made.values():
            yield node.lineno, f"this makes a second {kind} and spins it; the first one, made before, is never spun"


def _is_call(statement: ast.stmt) -> bool:
    return isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Call)


@slip
def shut_down_first(tree: ast.AST) -> Iterator[Place]:
    """Find a spin() behind rclpy.shutdown() or destroy_node() in one block."""
    for block in blocks(tree):
        ended = 0
        for statement in block:
            code = unparse(statement.value.func) if _is_call(statement) else ""  # type: ignore[attr-defined]
            if code.endswith((".shutdown", ".destroy_node")):
                ended = statement.lineno
            if ended and code.endswith("spin"):
                yield ended, f"line {statement.lineno} spins the node after this line has ended it: exchange the two"
                return


@slip_of(ast.While, ast.For, first=True)
def sleeps_between_spins(loop: ast.While | ast.For) -> Words:
    """Find time.sleep() in the loop that calls spin_once()."""
    found = list(calls(loop))
    if not any(name == "spin_once" for _, name in found):
        return
    for call, _ in found:
        value = call.args[0].value if call.args and isinstance(call.args[0], ast.Constant) else 0
        if unparse(call.func) in ("time.sleep", "sleep") and isinstance(value, int | float) and value >= PAUSE:
            yield (
                call,
                f"{unparse(call)} in the loop with spin_once(): while it sleeps, no callback runs, and each "
                "spin_once() runs one; leave it out, or call rclpy.spin(node)",
            )
