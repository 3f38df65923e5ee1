"""Code that never runs, or runs twice, in a file that is right but for it."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Place, Words, called, calls, functions, kept, nodes_of, unparse, walk
from gz_course.grader.feedback.slips import slip, slip_of

LONGEST_WAIT = 8.0  # [s] of counted ticks; a later message was hardly meant
ENDS = ("shutdown", "destroy_node")  # what belongs behind spin()
HARMLESS = frozenset({
    *ENDS, "try_shutdown", "join", "cancel", "destroy", "close", "stop", "remove_node", "print", "get_logger", "info",
    "warning", "error", "ok", "exit", "Twist",
})  # fmt: skip


@kept
def blocks(tree: ast.AST) -> tuple[list[ast.stmt], ...]:
    """Return the blocks of statements of a tree, outer ones first."""
    found = [
        getattr(node, name, None)
        for node in walk(tree)
        if not isinstance(node, ast.expr)
        for name in ("body", "orelse", "finalbody")
    ]
    return tuple(block for block in found if isinstance(block, list) and block and isinstance(block[0], ast.stmt))


def _call(statement: ast.stmt) -> str:
    """Return what a statement that is one call alone calls, such as `rclpy.spin`; empty for others."""
    if isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Call):
        return unparse(statement.value.func)
    return ""


@slip
def other_name_than_main(tree: ast.Module) -> Iterator[Place]:
    for node in tree.body:
        if not isinstance(node, ast.If) or not isinstance(node.test, ast.Compare):
            continue
        sides = [node.test.left, *node.test.comparators]
        texts = [side.value for side in sides if isinstance(side, ast.Constant)]
        if any(isinstance(side, ast.Name) and side.id == "__name__" for side in sides) and texts != ["__main__"]:
            yield (
                node.lineno,
                "the name of a file that is run is '__main__', with two underscores on either side: what stands below "
                f"this condition, {unparse(node.test)}, never runs",
            )


def _spins(statement: ast.stmt) -> bool:
    return _call(statement).rpartition(".")[2] == "spin"


@slip
def behind_spin(tree: ast.AST) -> Iterator[Place]:
    """Find what is called behind spin(), also in the `finally` of a `try` that spins.

    Right behind spin(), a cancel() that stands nowhere else and a function that publishes are no clearing up. What
    `except` and `finally` do, such as sending a stop, is, where the file publishes at other places, too.
    """
    publishing = {each.name: [n for _, n in calls(each)].count("publish") for each in functions(tree)}
    awaited = {name for name, count in publishing.items() if count}
    awaited |= {"cancel"} if sum(name == "cancel" for _, name in calls(tree)) == 1 else set()
    published = sum(name == "publish" for _, name in calls(tree))
    for block in blocks(tree):
        spins = [i for i, statement in enumerate(block) if _spins(statement)]
        after = block[spins[0] + 1 :] if spins else []
        meant = {id(statement) for statement in after}
        for each in block:
            if isinstance(each, ast.Try) and any(_spins(statement) for statement in each.body):
                after += [*(part for handler in each.handlers for part in handler.body), *each.finalbody]
        names = [name for statement in after for _, name in calls(statement)]
        last = names.count("publish") + sum(publishing.get(name, 0) for name in set(names))
        for statement in after:
            if id(statement) not in meant and published > last:
                continue
            harmless = HARMLESS - awaited if id(statement) in meant else HARMLESS
            if lost := [name for _, name in calls(statement) if name not in harmless]:
                yield (
                    statement.lineno,
                    f"{lost[0]}() comes after spin(), which returns only when the node is shut down: it does not run "
                    "before. A timer or a subscription calls a function while the node spins",
                )
                return


@slip
def behind_return(tree: ast.AST) -> Iterator[Place]:
    for block in blocks(tree):
        ends = [
            i for i, each in enumerate(block) if isinstance(each, ast.Return | ast.Raise | ast.Continue | ast.Break)
        ]
        for statement in block[ends[0] + 1 :] if ends else ():
            yield (
                statement.lineno,
                f"this line never runs: {unparse(block[ends[0]])[:40]}, line {block[ends[0]].lineno}, ends the "
                "block before it",
            )
            return


@slip
def cancelled_at_once(tree: ast.AST) -> Iterator[Place]:
    """Find a timer that `__init__` makes and cancels, and that nothing resets."""
    for function in (node for node in nodes_of(tree, ast.FunctionDef) if node.name == "__init__"):
        made = {
            unparse(node.targets[0]) for node in nodes_of(function, ast.Assign) if "create_timer" in called(node.value)
        }
        for statement in function.body:
            timer, _, method = _call(statement).rpartition(".")
            if timer in made and method == "cancel" and "reset" not in called(tree):
                yield statement.lineno, f"{timer} is cancelled in __init__, before it has fired once: cancel it later"


@slip_of(ast.ClassDef)
def never_true(owner: ast.ClassDef, tree: ast.AST) -> Words:
    """Find `if self.x:` where `self.x` begins as False, None or 0 and only the block below changes it.

    `if not self.x: return` keeps the lines behind it back in the same way.
    """
    begins = _first_values(owner)
    for node, behind in ((each, block[i + 1 :]) for block in blocks(owner) for i, each in enumerate(block)):
        if not isinstance(node, ast.If):
            continue
        name, held, where = _kept_back(node, behind)
        if name not in begins or begins[name]:
            continue
        inside = {id(each) for statement in held for each in walk(statement)}
        changed = [each for each in _assignments(owner) if _changes(each, name)]
        others = [each for each in changed if id(each) not in inside]
        outside = [each for each in _assignments(tree) if _changes(each, name.removeprefix("self"))]
        if len(others) != 1 or not len(others) < len(changed) == len(outside):
            continue
        yield (
            node,
            f"the code {where} never runs: {name} is {begins[name]} from the start, and only these lines change it",
        )


def _kept_back(node: ast.If, behind: list[ast.stmt]) -> tuple[str, list[ast.stmt], str]:
    """Return what a condition asks for, the statements that need it, and where they stand."""
    test, leaves = node.test, isinstance(node.body[-1], ast.Return | ast.Continue)
    if isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not) and leaves and not node.orelse:
        inner = [each for statement in node.body for each in walk(statement)]
        name = unparse(test.operand)
        if not any(_changes(each, name) for each in inner):
            return name, behind, f"after  if {unparse(test)}: {unparse(node.body[-1])}"
    name = unparse(test)
    return name, node.body, f"below  if {name}: "


def _first_values(owner: ast.ClassDef) -> dict[str, object]:
    """Return the constants that `__init__` assigns to attributes."""
    init = next((node for node in owner.body if isinstance(node, ast.FunctionDef) and node.name == "__init__"), None)
    return {
        unparse(node.targets[0]): node.value.value
        for node in (walk(init) if init is not None else ())
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant)
    }


def _assignments(tree: ast.AST) -> tuple[ast.Assign | ast.AugAssign | ast.AnnAssign, ...]:
    return nodes_of(tree, ast.Assign, ast.AugAssign, ast.AnnAssign)


def _changes(node: ast.AST, name: str) -> bool:
    targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
    return isinstance(node, ast.Assign | ast.AugAssign | ast.AnnAssign) and any(
        target is not None and name in unparse(target) for target in targets
    )


@slip
def one_callback_of_two(tree: ast.AST) -> Iterator[Place]:
    """Find two timers of one block with the same callback."""
    for block in blocks(tree):
        seen: dict[str, int] = {}
        for statement in block:
            for call in [node for node in nodes_of(statement, ast.Call) if len(node.args) == 2]:
                if not unparse(call.func).endswith("create_timer") or isinstance(statement, ast.FunctionDef):
                    continue
                callback = unparse(call.args[1])
                if callback in seen:
                    yield call.lineno, f"two timers call {callback}, this one and that in line {seen[callback]}"
                seen[callback] = call.lineno


@slip
def ended_before(tree: ast.AST) -> Iterator[Place]:
    """Find a publish() behind the call that ends ROS or the node, in one block."""
    for block in blocks(tree):
        ends = [i for i, each in enumerate(block) if _call(each).rpartition(".")[2] in ENDS]
        for statement in block[ends[0] + 1 :] if ends else ():
            if "publish" in called(statement):
                end = _call(block[ends[0]])
                yield statement.lineno, f"publish() comes after {end}(), which ends the publisher: exchange the two"
                return


@slip
def counts_too_far(tree: ast.AST) -> Iterator[Place]:
    """Find a callback of a timer that does something at one count of its ticks, long after the start."""
    functions = {node.name: node for node in nodes_of(tree, ast.FunctionDef)}
    for call in (node for node in nodes_of(tree, ast.Call) if len(node.args) >= 2):
        period, name = call.args[0], unparse(call.args[1]).rpartition(".")[2]
        if not unparse(call.func).endswith("create_timer") or not isinstance(period, ast.Constant):
            continue
        for node in walk(functions[name]) if name in functions else ():
            if not isinstance(node, ast.If) or not isinstance(node.test, ast.Compare):
                continue
            counter, limit = node.test.left, node.test.comparators[0]
            steps = any(
                isinstance(each, ast.AugAssign) and unparse(each.target) == unparse(counter)
                for each in walk(functions[name])
            )
            number = limit.value if isinstance(limit, ast.Constant) else None
            if not steps or not isinstance(node.test.ops[0], ast.Eq) or not isinstance(number, int | float):
                continue
            if isinstance(period.value, int | float) and number * period.value >= LONGEST_WAIT:
                yield (
                    node.lineno,
                    f"{unparse(counter)} is {number:g} only after {number:g} ticks of {period.value:g} s, which "
                    f"take {number * period.value:g} s",
                )
