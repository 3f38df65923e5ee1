"""Lists, generators, comparisons, logs and values that are not what a beginner takes them for."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import (
    Place,
    Words,
    assigned,
    last_name,
    left_early,
    nodes_of,
    unparse,
    walk,
)
from gz_course.grader.feedback.slips import slip, slip_of

READ_ONCE = frozenset({"filter", "map", "zip", "reversed", "iter", "enumerate"})
READERS = frozenset({
    "sum", "min", "max", "list", "tuple", "sorted", "set", "len", "mean", "fmean", "median", "array", "fsum",
})  # fmt: skip
CHANGES = frozenset({"remove", "pop", "insert"})
LEVELS = frozenset({"debug", "info", "warn", "warning", "error", "fatal"})
ONCE = frozenset({"map", "filter", "zip", "enumerate", "reversed", "iter"})
WHOLE_USE = frozenset({"min", "max", "sum", "sorted", "list", "tuple", "len", "set", "any", "all", "mean"})
SILENT = frozenset({"debug", "info"})


def given_to_names(function: ast.FunctionDef) -> dict[str, list[ast.expr | None]]:
    """Return what is assigned to each name, in order; None for a loop variable or another change."""
    found: dict[str, list[ast.expr | None]] = {}
    for node in walk(function):
        if isinstance(node, ast.Assign) and len(node.targets) == 1 and isinstance(node.targets[0], ast.Name):
            found.setdefault(node.targets[0].id, []).append(node.value)
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            found.setdefault(node.id, [])
        elif isinstance(node, ast.AugAssign):
            found.setdefault(unparse(node.target), []).append(None)
    return found


@slip_of(ast.FunctionDef)
def read_twice(function: ast.FunctionDef) -> Words:
    """Find a generator, or what filter() and map() return, that is read to its end twice."""
    for name, values in given_to_names(function).items():
        value = values[0] if len(values) == 1 else None
        what = "a generator" if isinstance(value, ast.GeneratorExp) else ""
        if isinstance(value, ast.Call) and isinstance(value.func, ast.Name) and value.func.id in READ_ONCE:
            what = f"what {value.func.id}() returns"
        readers = sorted(_readers(function, name), key=lambda node: (node.lineno, node.col_offset)) if what else []
        if len(readers) > 1:
            yield (
                readers[1],
                f"{name} is {what}, which can be read only once: line {readers[0].lineno} has read it to its end, "
                "and here it is empty; make a list, [... for ... in ...] or list(...)",
            )


def _readers(function: ast.FunctionDef, name: str) -> Iterator[ast.expr]:
    for node in walk(function):
        if isinstance(node, ast.Call) and last_name(node.func) in READERS:
            yield from (each for each in node.args if isinstance(each, ast.Name) and each.id == name)
        elif isinstance(node, ast.For | ast.comprehension) and unparse(node.iter) == name:
            ends = isinstance(node, ast.For) and left_early(node)
            if not ends:
                yield node.iter


@slip_of(ast.For)
def changed_while_read(loop: ast.For) -> Words:
    """Find a loop over a list that takes elements out of the same list, and goes on."""
    over = loop.iter
    if isinstance(over, ast.Call) and last_name(over.func) == "enumerate" and over.args:
        over = over.args[0]
    if not isinstance(over, ast.Name | ast.Attribute):
        return
    name = unparse(over)
    for node in walk(loop):
        call = isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in CHANGES
        taken = call and unparse(node.func.value) == name  # type: ignore[attr-defined]
        if isinstance(node, ast.Delete):
            taken = any(isinstance(each, ast.Subscript) and unparse(each.value) == name for each in node.targets)
        if taken and not _leaves_after(loop.body, node):
            yield (
                node,
                f"this changes {name} while the loop in line {loop.lineno} runs over it: what follows moves up, so "
                "the loop skips the next element; make a new list of those that are to stay",
            )
            break


def _leaves_after(block: list[ast.stmt], node: ast.AST) -> bool:
    """Return whether a loop is left for certain after a node in one of its blocks."""
    for number, statement in enumerate(block):
        if any(each is node for each in walk(statement)):
            later = block[number:]
            inner = (getattr(statement, part, []) for part in ("body", "orelse", "finalbody"))
            return any(isinstance(each, ast.Break | ast.Return) for each in later) or any(
                _leaves_after(each, node) for each in inner if isinstance(each, list)
            )
    return False


@slip_of(ast.Compare)
def compared_with_nan(node: ast.Compare) -> Words:
    """Find comparisons that are always the same: with nan by value, with a float by identity."""
    for left, operator, right in zip([node.left, *node.comparators], node.ops, node.comparators, strict=False):
        kinds = {_constant(side) for side in (left, right)}
        if isinstance(operator, ast.Eq | ast.NotEq) and "nan" in kinds:
            yield "nothing is equal to nan, not even nan itself: math.isnan(x) asks for it"
        elif isinstance(operator, ast.Is | ast.IsNot) and kinds & {"nan", "inf"}:
            yield (
                "`is` asks for the same object, not for the same value: math.isinf(x) and math.isnan(x) ask for "
                "inf and nan"
            )


def _constant(node: ast.expr) -> str:
    """Return `inf` or `nan` for math.inf, float('nan') and the like; empty for anything else."""
    text = unparse(node).replace('"', "'").lower().lstrip("+-")
    names = {f"{module}.{name}": name for module in ("math", "np", "numpy") for name in ("inf", "nan")}
    names |= {f"float('{sign}{name}')": name for sign in ("", "-", "+") for name in ("inf", "nan")}
    return names.get(text, "")


@slip
def log_arguments(tree: ast.AST) -> Iterator[Place]:
    """Find a line of the node's logger with several arguments, as print() and Python's logging take them."""
    loggers = {
        unparse(node.targets[0]) for node in nodes_of(tree, ast.Assign) if unparse(node.value).endswith("get_logger()")
    }
    for node in nodes_of(tree, ast.Call):
        if not isinstance(node.func, ast.Attribute) or node.func.attr not in LEVELS:
            continue
        owner = unparse(node.func.value)
        if len(node.args) > 1 and (owner.endswith("get_logger()") or owner in loggers):
            yield (
                node.lineno,
                f"{node.func.attr}() of the node's logger takes one text, and no values to fill in: write an f-string, "
                "or put the values in with  '...' % (...)",
            )


@slip_of(ast.FunctionDef)
def used_up(function: ast.FunctionDef) -> Words:
    """Find a generator that is gone through twice: the second time it is empty."""
    for node in walk(function):
        target = node.targets[0] if isinstance(node, ast.Assign) and len(node.targets) == 1 else None
        if not isinstance(target, ast.Name) or not isinstance(node, ast.Assign) or not _once(node.value):
            continue
        if sum(_is_store(each, target.id) for each in walk(function)) > 1:
            continue
        uses = sorted({line for each in walk(function) if (line := _goes_through(each, target.id))})
        if len(uses) > 1:
            yield (
                uses[1],
                f"{target.id} of line {node.lineno} can be gone through once only, which line {uses[0]} does: here it "
                "is empty; a list, [...] or list(...), can be read again",
            )


def _once(node: ast.expr) -> bool:
    return isinstance(node, ast.GeneratorExp) or (
        isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in ONCE
    )


def _is_store(node: ast.AST, name: str) -> bool:
    return isinstance(node, ast.Name) and node.id == name and isinstance(node.ctx, ast.Store)


def _goes_through(node: ast.AST, name: str) -> int:
    """Return the line in which a node goes through a whole iterable; 0 if it does not."""
    if isinstance(node, ast.For | ast.comprehension) and isinstance(node.iter, ast.Name) and node.iter.id == name:
        return node.iter.lineno
    whole = isinstance(node, ast.Call) and unparse(node.func).rpartition(".")[2] in WHOLE_USE
    if isinstance(node, ast.Call) and whole and name in [unparse(each) for each in node.args]:
        return node.lineno
    return 0


@slip_of(ast.FunctionDef, first=True)
def same_object(function: ast.FunctionDef) -> Words:
    """Find `hit.header = scan.header` and then `hit.header.frame_id = ...`, which changes the scan too."""
    for node in nodes_of(function, ast.Assign):
        if not isinstance(node.value, ast.Attribute) or len(node.targets) != 1:
            continue
        target, value = unparse(node.targets[0]), unparse(node.value)
        if not isinstance(node.targets[0], ast.Attribute) or value.rpartition(".")[2] not in PARTS:
            continue
        for each in nodes_of(function, ast.Assign):
            if each.lineno <= node.lineno:
                continue
            if unparse(each.targets[0]).startswith(f"{target}.") and _is_used_again(node, each, function):
                yield (
                    each,
                    f"{target} is {value} itself since line {node.lineno}, no copy: this line changes both; set "
                    "the fields one by one, or copy.deepcopy() it",
                )


def _is_used_again(shared: ast.Assign, changed: ast.Assign, function: ast.FunctionDef) -> bool:
    """Return whether what was shared may be read after it was changed, other than where it is shared."""
    root = unparse(shared.value).partition(".")[0]
    own = {id(node) for node in walk(shared)}
    uses = [
        node.lineno
        for node in nodes_of(function, ast.Name)
        if node.id == root and isinstance(node.ctx, ast.Load) and id(node) not in own
    ]
    rounds = [
        each.lineno for each in walk(function) if isinstance(each, ast.For | ast.While) and changed in list(walk(each))
    ]
    return root == "self" or any(line > min([changed.lineno, *rounds]) for line in uses)


PARTS = frozenset(
    {"header", "stamp", "pose", "position", "orientation", "twist", "linear", "angular", "point", "transform"}
)


@slip
def identity(tree: ast.AST) -> Iterator[Place]:
    """Find `is` between values that may be equal without being the same object."""
    constants = {
        last_name(target)
        for target, value in assigned(tree)
        if isinstance(value, ast.Constant) and type(value.value) in (str, int, float)
    } - {"", *_members(tree)}
    handed_on = {(last_name(target), last_name(value)) for target, value in assigned(tree)}
    for node in nodes_of(tree, ast.Compare):
        if not isinstance(node.ops[0], ast.Is | ast.IsNot):
            continue
        sides = (node.left, node.comparators[0])
        if any(
            isinstance(side, ast.Constant) and (side.value is None or isinstance(side.value, bool)) for side in sides
        ):
            continue
        for side, other in (sides, sides[::-1]):
            literal = isinstance(side, ast.Constant) and type(side.value) in (str, int, float)
            same = (last_name(other), last_name(side)) in handed_on
            if literal or (last_name(side) in constants and not same):
                word, sign = ("is", "==") if isinstance(node.ops[0], ast.Is) else ("is not", "!=")
                yield (
                    node.lineno,
                    f"{unparse(node)[:60]}: {word} asks whether both are the same object, {sign} whether they are "
                    "equal",
                )
                break


def _members(tree: ast.AST) -> set[str]:
    """Return the names of the members of enumerations, each of which is one object."""
    return {
        last_name(target)
        for each in nodes_of(tree, ast.ClassDef)
        if any(last_name(base).endswith(("Enum", "Flag")) for base in each.bases)
        for target, _ in assigned(each)
    }


@slip_of(ast.BinOp)
def repeated_rows(node: ast.BinOp) -> Words:
    """Find `[[0] * width] * height`, whose rows are all the same list."""
    if isinstance(node.op, ast.Mult) and isinstance(node.left, ast.List):
        inner = node.left.elts[0] if len(node.left.elts) == 1 else None
        rows = isinstance(inner, ast.List | ast.ListComp | ast.Dict | ast.Set) or (
            isinstance(inner, ast.BinOp) and isinstance(inner.left, ast.List)
        )
        if rows:
            yield (
                f"{unparse(node)[:60]} repeats one and the same row: a change of one row changes all; "
                "[[0] * width for _ in range(height)] makes a row each time"
            )


@slip_of(ast.Call)
def whole_seconds_of_a_stamp(node: ast.Call) -> Words:
    """Find `Time(seconds=stamp.sec)`, which leaves the nanoseconds out."""
    if unparse(node.func).rpartition(".")[2] not in ("Time", "Duration"):
        return
    given = {each.arg: unparse(each.value) for each in node.keywords}
    if given.get("seconds", "").endswith(".sec") and not {"nanoseconds", "nanosec"} & set(given):
        yield (
            f"{unparse(node)[:60]} has the whole seconds only, and the stamp's nanosec is left out: "
            "Time.from_msg(stamp) takes both"
        )


@slip
def python_logging(tree: ast.AST) -> Iterator[Place]:
    """Find lines for the log that Python's own logging swallows, because nothing has set it up."""
    imported = any(isinstance(node, ast.Import) and any(a.name == "logging" for a in node.names) for node in walk(tree))
    calls = {unparse(node.func): node.lineno for node in nodes_of(tree, ast.Call)}
    if not imported or any("basicConfig" in call or "addHandler" in call for call in calls):
        return
    for call, line in calls.items():
        owner, _, method = call.rpartition(".")
        if method in SILENT and owner and "get_logger" not in owner:
            yield (
                line,
                f"{call}() of Python's logging shows nothing here: the node's log is self.get_logger().info(text)",
            )
            return


@slip_of(ast.ClassDef)
def zero_is_false(owner: ast.ClassDef) -> Words:
    """Find `if not self.x:` where self.x begins as None and is later set to 0: it asks for None and for 0 alike."""
    given: dict[str, list[object]] = {}
    for node in nodes_of(owner, ast.Assign):
        if isinstance(node.value, ast.Constant):
            given.setdefault(unparse(node.targets[0]), []).append(node.value.value)
    for block in nodes_of(owner, ast.If):
        if isinstance(block.test, ast.UnaryOp) and isinstance(block.test.op, ast.Not):
            name = unparse(block.test.operand)
            values = given.get(name, [])
            zero = next((v for v in values if type(v) in (int, float) and v == 0), None)
            if None in values and zero is not None:
                yield (
                    block.test,
                    f"not {name} holds for {zero}, too, not only for None: {zero} counts as false; ask {name} is None",
                )
