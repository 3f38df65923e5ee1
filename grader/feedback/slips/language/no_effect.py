"""Statements without the effect that was meant: what is computed and thrown away, filled and never sent."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Place, Words, assignments, called, functions, nodes_of, unparse, walk
from gz_course.grader.feedback.slips import slip, slip_of
from gz_course.grader.feedback.slips.language.unreached import blocks

BEFORE = ("results",)

FUNCTIONS = frozenset({"rclpy.ok", "math.isfinite", "math.isnan", "math.isinf", "isfinite", "isnan", "isinf"})
# Functions of math and NumPy.
PURE = frozenset({
    "append", "clip", "cos", "sin", "sqrt", "atan2", "arctan2", "remainder", "fmod", "radians", "degrees", "flip",
    "fliplr", "flipud", "roll", "where", "nan_to_num", "reshape", "transpose", "sort", "delete", "insert", "round",
    "concatenate", "maximum", "minimum", "abs", "floor", "ceil",
})  # fmt: skip
MESSAGES = frozenset({
    "Twist", "TwistStamped", "String", "Float32", "Float64", "Int32", "Bool", "Odometry", "LaserScan", "PointStamped",
    "PoseStamped", "Point", "Vector3", "OccupancyGrid", "TransformStamped", "Pose", "Header", "JointState", "Image",
})  # fmt: skip


@slip_of(ast.Expr)
def thrown_away(node: ast.Expr) -> Words:
    """Find a comparison or an arithmetic expression that is a statement of its own."""
    code = unparse(node.value)[:60]
    if isinstance(node.value, ast.Compare) and isinstance(node.value.ops[0], ast.Eq):
        yield f"{code} compares and throws the result away: = assigns, == compares"
    elif isinstance(node.value, ast.Compare):
        yield f"{code} compares and throws the result away: return, if or = keeps it"
    elif isinstance(node.value, ast.BinOp):
        yield f"{code} is computed and thrown away: += or = keeps the result"
    elif isinstance(node.value, ast.Call) and _only_returns(node.value):
        name = unparse(node.value.func)
        yield (
            f"{code} is thrown away: {name}() does not change what it is given, it returns the result; "
            f"... = {name}(...) keeps it"
        )


def _only_returns(call: ast.Call) -> bool:
    """Return whether a call does nothing but return a value."""
    owner, _, name = unparse(call.func).rpartition(".")
    if name.startswith("do_transform_"):
        return True
    if owner in ("np", "numpy", "math"):
        return name in PURE and not any(each.arg in ("out", "copyto") for each in call.keywords)
    return (name == "sorted" and not owner) or (name == "transform" and "buf" in owner.lower() and len(call.args) == 2)


@slip_of(ast.Assign)
def signs_for_operators(node: ast.Assign) -> Words:
    """Find `x =+ 1`, which assigns +1."""
    if isinstance(node.value, ast.UnaryOp) and len(node.targets) == 1:
        operand = node.value.operand
        if isinstance(node.value.op, ast.UAdd) and isinstance(operand, ast.Constant):
            name = unparse(node.targets[0])
            value = unparse(operand)
            yield f"{name} =+ {value} sets it to {value} in every call: {name} += {value} adds {value}"


@slip
def always_true(tree: ast.AST) -> Iterator[Place]:
    """Find `state == 'go' or 'turn'`, whose second half is always true."""
    for node in walk(tree):
        if not isinstance(node, ast.If | ast.While | ast.IfExp | ast.Assert):
            continue
        for each in _alternatives(node.test):
            if isinstance(each.op, ast.Or):
                constants = [value for value in each.values[1:] if isinstance(value, ast.Constant) and value.value]
                if constants:
                    yield (
                        node.test.lineno,
                        f"{unparse(each)[:60]} is always true, because {unparse(constants[0])} is: each "
                        "side of or is a condition of its own",
                    )
        tested = node.test.operand if isinstance(node.test, ast.UnaryOp) else node.test
        if unparse(tested) in FUNCTIONS:
            name = unparse(tested)
            yield (
                node.test.lineno,
                f"{name} without brackets is the function, which is always true: {name}(...) calls it",
            )


def _published_again(function: ast.FunctionDef, statement: ast.stmt, name: str) -> bool:
    """Return whether a message is published behind a statement: further down, or in the next iteration of a loop."""
    if any(each.lineno > statement.lineno and _published(each) == name for each in _statements(function)):
        return True
    for loop in _statements(function):
        inside = list(_statements(loop)) if isinstance(loop, ast.For | ast.While) else []
        if statement in inside and not any(_makes(each, name) for each in inside):
            return True
    return False


def _statements(tree: ast.AST) -> tuple[ast.stmt, ...]:
    return nodes_of(tree, ast.stmt)


def _published(statement: ast.stmt) -> str:
    """Return the name of the message if the statement is a publish() of one."""
    if isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Call) and len(statement.value.args) == 1:
        call = statement.value
        if unparse(call.func).endswith(".publish") and isinstance(call.args[0], ast.Name | ast.Attribute):
            return unparse(call.args[0])
    return ""


def _makes(statement: ast.stmt, name: str) -> bool:
    return isinstance(statement, ast.Assign) and any(unparse(target) == name for target in statement.targets)


@slip_of(ast.FunctionDef)
def first_iteration(function: ast.FunctionDef) -> Words:
    """Find a return at the end of the body of a loop that collects something: the loop ends at once."""
    for node in nodes_of(function, ast.For):
        if not isinstance(node.body[-1], ast.Return):
            continue
        if any(isinstance(each, ast.Continue | ast.Break) for each in walk(node)):
            continue
        if _set_in(function.body, before=node.lineno) & _set_in(node.body, before=node.body[-1].lineno):
            yield (
                node.body[-1],
                f"{unparse(node.body[-1])[:40]} stands inside of the loop of line {node.lineno}, which ends in "
                "its first iteration: further to the left it comes after the loop",
            )


@slip
def timers_that_go_on(tree: ast.AST) -> Iterator[Place]:
    """Find a timer that is to end by losing its name, or by reset()."""
    timers = {
        unparse(node.targets[0])
        for node in nodes_of(tree, ast.Assign)
        if isinstance(node.value, ast.Call) and "create_timer" in called(node.value)
    }
    if "cancel" in called(tree) or "destroy_timer" in called(tree):
        return
    inits = {id(inner) for node in nodes_of(tree, ast.FunctionDef) if node.name == "__init__" for inner in walk(node)}
    for node in walk(tree):
        if id(node) in inits:
            continue
        lost = isinstance(node, ast.Assign) and unparse(node.value) in ("None", "False")
        if isinstance(node, ast.Assign | ast.Delete) and (lost or isinstance(node, ast.Delete)):
            if (name := unparse(node.targets[0])) in timers:
                yield (
                    node.lineno,
                    f"{unparse(node)} takes the name away, and the timer goes on: {name}.cancel() ends it",
                )
        elif isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
            owner, _, method = unparse(node.value.func).rpartition(".")
            if owner in timers and method == "reset":
                yield (
                    node.lineno,
                    f"{owner}.reset() starts the period again, and the timer fires again: {owner}.cancel() ends it",
                )
            if owner in timers and method in ("is_canceled", "is_ready"):
                yield node.lineno, f"{owner}.{method}() only asks: {owner}.cancel() ends the timer"


def _alternatives(test: ast.expr) -> Iterator[ast.BoolOp]:
    """Yield the `and` and `or` of a condition, not those within its comparisons and calls."""
    parts = [test.operand] if isinstance(test, ast.UnaryOp) else []
    if isinstance(test, ast.BoolOp):
        yield test
        parts = test.values
    for part in parts:
        yield from _alternatives(part)


@slip_of(ast.FunctionDef)
def never_sent(function: ast.FunctionDef) -> Words:
    """Find a message that a function makes and at most fills, and hands to nobody."""
    loads = [n for n in nodes_of(function, ast.Name) if isinstance(n.ctx, ast.Load)]
    bases = {
        id(inner)
        for node in nodes_of(function, ast.Attribute)
        if isinstance(node.ctx, ast.Store)
        for inner in walk(node)
    }
    for target, node in assignments(function):
        if not isinstance(target, ast.Name) or not isinstance(node.value, ast.Call):
            continue
        kind = unparse(node.value.func).rpartition(".")[2]
        if kind in MESSAGES and all(id(each) in bases for each in loads if each.id == target.id):
            yield (
                node,
                f"{target.id}, a {kind}, is made here and never used: nothing publishes it or puts it into another "
                "message",
            )


def _set_in(block: list[ast.stmt], before: int) -> set[str]:
    """Return the names that are assigned in a block, or appended to, in lines before the given one."""
    names = set()
    for node in (inner for statement in block for inner in walk(statement)):
        if getattr(node, "lineno", before) >= before:
            continue
        if isinstance(node, ast.Assign):
            names |= {unparse(target) for target in node.targets}
        elif isinstance(node, ast.AugAssign):
            names.add(unparse(node.target))
        elif isinstance(node, ast.Call) and unparse(node.func).endswith(".append"):
            names.add(unparse(node.func).removesuffix(".append"))
    return names


@slip
def changed_after_publish(tree: ast.AST) -> Iterator[Place]:
    """Find a field that is set behind the publish() of its message, which nothing publishes after that."""
    for function, block in ((each, block) for each in functions(tree) for block in blocks(each)):
        for i, statement in enumerate(block):
            name = _published(statement)
            if not name or name.startswith("self."):
                continue
            later = block[i + 1 :]
            made = any(_makes(each, name) for outer in later for each in _statements(outer))
            if made or _published_again(function, statement, name):
                continue
            for each in (inner for outer in later for inner in _statements(outer)):
                if isinstance(each, ast.Assign) and unparse(each.targets[0]).startswith(f"{name}."):
                    yield (
                        each.lineno,
                        f"{unparse(each.targets[0])} is set after publish({name}) in line {statement.lineno}: what "
                        "was sent does not change any more",
                    )
                    break
