"""Mistakes with the callbacks of an action server that raise no error."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import (
    Place,
    assigned,
    called,
    functions,
    last_name,
    nodes_of,
    returned_by,
    set_to,
    unparse,
    walk,
)
from gz_course.grader.feedback.slips import slip

# Position of each callback among the arguments; -1 for those that are given by name only.
PLACES = {"execute_callback": 3, "goal_callback": -1, "cancel_callback": -1, "handle_accepted_callback": -1}
DRIVES = frozenset({"publish", "sleep"})  # what a loop calls that drives
SPINS = frozenset({"rclpy.spin_once", "rclpy.spin", "rclpy.spin_until_future_complete"})
FUNCTIONS = ast.FunctionDef | ast.AsyncFunctionDef
SPEAKS = frozenset({"publish", "publish_feedback"})
PAUSES = frozenset({"sleep", "wait", "wait_for", "spin_once", "join", "get", "sleep_for", "sleep_until", "acquire"})
LOCKS = frozenset({"Lock", "RLock", "Semaphore"})
ENDS = ("succeed", "abort", "canceled")
ANSWERS = {"goal_callback": "GoalResponse", "cancel_callback": "CancelResponse"}


def _callbacks(tree: ast.AST) -> Iterator[tuple[str, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda]]:
    """Yield the role and the function of each callback that is passed to an ActionServer."""
    functions = {n.name: n for n in nodes_of(tree, ast.FunctionDef, ast.AsyncFunctionDef)}
    for node in nodes_of(tree, ast.Call):
        if unparse(node.func).rpartition(".")[2] != "ActionServer":
            continue
        given = {each.arg: each.value for each in node.keywords if each.arg in PLACES}
        given |= {role: node.args[i] for role, i in PLACES.items() if 0 <= i < len(node.args)}
        for role, value in given.items():
            name = unparse(value).rpartition(".")[2]
            if isinstance(value, ast.Lambda):
                yield str(role), value
            elif name in functions:
                yield str(role), functions[name]


@slip
def answers(tree: ast.AST) -> Iterator[Place]:
    """Find a callback that answers to a goal, or to a wish to cancel, with something else than an answer."""
    for role, function in _callbacks(tree):
        if role not in ANSWERS:
            continue
        returned, kind = returned_by(function), ANSWERS[role]
        others = set(ANSWERS.values()) - {kind}
        wrong = [
            each
            for each in returned
            if each is None
            or isinstance(each, ast.Constant | ast.Compare | ast.BoolOp)
            or (isinstance(each, ast.Attribute) and last_name(each.value) in others)
        ]
        if wrong or not returned:
            what = unparse(wrong[0]) if wrong and wrong[0] is not None else "nothing"
            yield (
                wrong[0].lineno if wrong and wrong[0] is not None else function.lineno,
                f"{role} returns {what[:40]}, which is no answer, so it counts as a refusal: return {kind}.ACCEPT or "
                f"{kind}.REJECT",
            )


@slip
def no_result(tree: ast.AST) -> Iterator[Place]:
    for role, function in _callbacks(tree):
        if role == "execute_callback" and all(each is None for each in returned_by(function)):
            yield (
                function.lineno,
                "execute returns nothing, and what it returns is the result that the client gets: return the Result of "
                "the action after goal_handle.succeed()",
            )
        elif role == "execute_callback" and isinstance(function, ast.FunctionDef):
            inside = {id(n) for f in functions(function) if f is not function for n in walk(f)}
            for node in nodes_of(function, ast.Return):
                if node.value is None and id(node) not in inside:
                    yield (
                        node.lineno,
                        "this return gives no result, and a goal without a result never ends for its client: return a "
                        "Result of the action here, too",
                    )


@slip
def no_message_as_result(tree: ast.AST) -> Iterator[Place]:
    """Find an execute callback that returns a number, a truth value, or a field of its Result."""
    for role, function in _callbacks(tree):
        if role != "execute_callback" or not isinstance(function, ast.FunctionDef):
            continue
        values = set_to(function)
        results = {
            name for name, given in values.items() if any(last_name(_callee(each)) == "Result" for each in given)
        }
        for value in returned_by(function):
            owner = unparse(value.value) if isinstance(value, ast.Attribute) else ""
            counted = values.get(unparse(value), []) if isinstance(value, ast.Name) else [value]
            number = bool(counted) and all(
                isinstance(each, ast.Constant) and each.value is not None for each in counted
            )
            if value is not None and (owner in results or number):
                yield (
                    value.lineno,
                    f"execute returns `{unparse(value)}`, and what it returns is the result that the client gets: "
                    "return the Result of the action, with its fields set",
                )


def _callee(node: ast.expr) -> ast.expr:
    return node.func if isinstance(node, ast.Call) else node


@slip
def keeps_the_only_thread(tree: ast.AST) -> Iterator[Place]:
    """Find a loop that waits in execute, in a node with one thread; a coroutine without await is no other."""
    names = {unparse(node.func).rpartition(".")[2] for node in nodes_of(tree, ast.Call) if not _one_thread(node)}
    if names & {"MultiThreadedExecutor", "Thread", "spin_once", "spin_some", "start_new_thread"} or "spin" not in names:
        return
    for role, function in _callbacks(tree):
        if role != "execute_callback" or isinstance(function, ast.Lambda):
            continue
        if any(isinstance(each, ast.Await | ast.AsyncFor | ast.AsyncWith) for each in walk(function)):
            continue
        loop = next(iter(nodes_of(function, ast.While)), None)
        if loop is not None and isinstance(function, ast.AsyncFunctionDef) and not called(loop) >= DRIVES:
            continue
        if loop is not None:
            yield (
                loop.lineno,
                "the loop in execute keeps the only thread of the node: neither /odom nor a wish to cancel is heard "
                "while it runs. Spin with a MultiThreadedExecutor, and callbacks in a ReentrantCallbackGroup",
            )


def _one_thread(call: ast.Call) -> bool:
    """Return whether a call makes an executor of many threads with a single one."""
    given = [*call.args[:1], *(each.value for each in call.keywords if each.arg == "num_threads")]
    many = unparse(call.func).rpartition(".")[2] == "MultiThreadedExecutor"
    return many and any(isinstance(each, ast.Constant) and each.value == 1 for each in given)


@slip
def spins_itself(tree: ast.AST) -> Iterator[Place]:
    """Find an execute callback that spins the node it belongs to."""
    for role, function in _callbacks(tree):
        for call in nodes_of(function, ast.Call):
            name = unparse(call.func)
            if role == "execute_callback" and name in SPINS and call.args and unparse(call.args[0]) == "self":
                yield (
                    call.lineno,
                    f"{name}(self, ...) inside of a callback takes the node away from the executor that spins it, and "
                    "then no goal, result or cancellation is served: time.sleep() waits, and a MultiThreadedExecutor "
                    "runs the other callbacks meanwhile",
                )


@slip
def ended_by_the_answer(tree: ast.AST) -> Iterator[Place]:
    """Find a goal that is ended in the callback that only answers whether it may be cancelled."""
    for role, function in _callbacks(tree):
        for call in nodes_of(function, ast.Call):
            name = unparse(call.func)
            if role == "cancel_callback" and name.rpartition(".")[2] == "canceled":
                yield (
                    call.lineno,
                    f"cancel_callback only answers whether the goal may be cancelled, and {name}() raises an error "
                    "there: call it in execute, where is_cancel_requested is true, and return the result",
                )


@slip
def never_executed(tree: ast.AST) -> Iterator[Place]:
    """Find a callback for accepted goals that does not execute them."""
    for role, function in _callbacks(tree):
        if role == "handle_accepted_callback" and not re.search(r"\bexecute\b|notify_execute", unparse(function)):
            yield (
                function.lineno,
                "handle_accepted_callback takes over what happens to an accepted goal, and this one never calls "
                "goal_handle.execute(), so the goal is not executed: leave it out, or call it there",
            )


@slip
def ends_before_it_drives(tree: ast.AST) -> Iterator[Place]:
    """Find succeed() in execute above its first loop, not below a condition."""
    for role, function in _callbacks(tree):
        if role != "execute_callback" or isinstance(function, ast.Lambda):
            continue
        loop = next((each for each in function.body if isinstance(each, ast.While | ast.For)), None)
        for statement in function.body:
            call = statement.value if isinstance(statement, ast.Expr) else None
            if loop is None or statement.lineno >= loop.lineno or not isinstance(call, ast.Call):
                continue
            name = unparse(call.func)
            if name.rpartition(".")[2] in ENDS:
                yield (
                    statement.lineno,
                    f"{name}() ends the goal, and it stands above the loop that does the work: move it below",
                )


@slip
def without_a_pause(tree: ast.AST) -> Iterator[Place]:
    """Find a loop in execute that publishes as fast as the computer can."""
    sleeping = {each.name for each in walk(tree) if isinstance(each, FUNCTIONS) and _pauses(each)}
    speaking = {each.name for each in walk(tree) if isinstance(each, FUNCTIONS) and called(each) & SPEAKS}
    for role, function in _callbacks(tree):
        if role != "execute_callback" or isinstance(function, ast.Lambda):
            continue
        inner = nodes_of(function, ast.While)
        for loop in inner:
            if called(loop) & (SPEAKS | speaking) and not _pauses(loop) and not called(loop) & sleeping:
                yield (
                    loop.lineno,
                    "this loop publishes without a pause, as often as the computer can, and leaves no time to the "
                    "callbacks: call time.sleep(0.1) in every iteration",
                )
                return


def _pauses(node: ast.AST) -> bool:
    awaits = any(isinstance(each, ast.Await) for each in walk(node))
    return awaits or bool(called(node) & PAUSES)


@slip
def keeps_a_lock(tree: ast.AST) -> Iterator[Place]:
    """Find a lock that is held while a loop sleeps, in a file where a callback waits for the same lock."""
    made = {unparse(t) for t, v in assigned(tree) if isinstance(v, ast.Call) and last_name(v.func) in LOCKS}
    for function in nodes_of(tree, ast.FunctionDef):
        for lock, line, held in _held(function):
            loops = (n for part in held for n in nodes_of(part, ast.While, ast.For))
            sleeps = any("sleep" in called(loop) for loop in loops)
            others = (each for each in functions(tree) if each is not function)
            waits = next((each for each in others if any(name == lock for name, _, _ in _held(each))), None)
            if lock in made and sleeps and waits is not None:
                yield (
                    line,
                    f"{lock} is held during the whole loop, and {waits.name}() waits for it as long: take the lock "
                    "inside of the loop, only to read or to write",
                )


def _held(function: ast.FunctionDef) -> Iterator[tuple[str, int, list[ast.stmt]]]:
    """Yield each lock that a function takes, the line, and the statements that run while it holds the lock."""
    for node in nodes_of(function, ast.With):
        for item in node.items:
            yield unparse(item.context_expr), node.lineno, node.body
    for number, statement in enumerate(function.body):
        call = statement.value if isinstance(statement, ast.Expr) else None
        if isinstance(call, ast.Call) and last_name(call.func) == "acquire":
            lock, held = unparse(call.func).rpartition(".")[0], []
            for later in function.body[number + 1 :]:
                if f"{lock}.release()" in unparse(later):
                    break
                held.append(later)
            yield lock, statement.lineno, held
