"""Messages that wait for a transform of their time in a list or an attribute, and are lost there, or wait for ever."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import (
    Place,
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
from gz_course.grader.feedback.slips import slip, slip_of
from gz_course.grader.feedback.slips.nodes.transforms import ASKED, KEEPS

TAKES = frozenset({"pop", "popleft", "get", "get_nowait"})
REMOVES = TAKES | {"remove", "clear"}
EMPTY = frozenset({"[]", "{}", "list()", "deque()", "dict()", "None"})
STEPS = 4  # names followed at most


def _asks(node: ast.AST, tree: ast.AST) -> bool:
    """Return whether a node asks tf2 for a transform, itself or in a method that it calls."""
    names = called(node)
    return bool(names & ASKED) or any(each.name in names and called(each) & ASKED for each in functions(tree))


def _names(node: ast.AST) -> set[str]:
    return {unparse(each) for each in nodes_of(node, ast.Name, ast.Attribute, ast.Subscript)}


def _while_any(loop: ast.AST) -> str:
    """Return the list of `while waiting:`, `while len(waiting) > 0:` or `for _ in range(len(waiting)):`."""
    match loop:
        case ast.While(test=ast.Name() | ast.Attribute() as kept):
            return unparse(kept)
        case ast.While(test=ast.Call(func=ast.Name(id="len"), args=[kept])):
            return unparse(kept)
        case ast.While(
            test=ast.Compare(
                left=ast.Call(func=ast.Name(id="len"), args=[kept]),
                ops=[ast.Gt() | ast.NotEq()],
                comparators=[ast.Constant(value=0)],
            )
        ):
            return unparse(kept)
        case ast.For(iter=ast.Call(func=ast.Name(id="range"), args=[ast.Call(func=ast.Name(id="len"), args=[kept])])):
            return unparse(kept)
    return ""


def _over(loop: ast.For) -> str:
    """Return the list over which a loop runs, also where the loop has a copy: `for each in list(waiting):`."""
    match loop.iter:
        case ast.Call(func=ast.Name(id="list" | "tuple" | "reversed"), args=[kept]):
            return unparse(kept)
        case ast.Call(func=ast.Attribute(value=kept, attr="copy")) | ast.Subscript(value=kept, slice=ast.Slice()):
            return unparse(kept)
    return unparse(loop.iter)


@slip_of(ast.FunctionDef)
def taken_too_early(function: ast.FunctionDef, tree: ast.AST) -> Words:
    """Find a loop that takes each message out of its list, asks for its transform then, and never puts it back."""
    for loop in nodes_of(function, ast.While, ast.For):
        if not _asks(loop, tree):
            continue
        kept, name, line = _while_any(loop), "", 0
        for target, value in assigned(loop):
            takes = isinstance(value, ast.Call) and last_name(value.func) in TAKES
            if takes and kept and unparse(value).startswith(f"{kept}."):
                name, line = unparse(target), value.lineno
        if isinstance(loop, ast.For) and not name:
            kept, each = _over(loop), unparse(loop.target)
            asked = [call.lineno for call, _ in calls(loop) if _asks(call, tree)]
            for call, method in calls(loop):
                out = method == "remove" and unparse(call) == f"{kept}.remove({each})"
                if out and call.lineno < min(asked) and _always(loop, call):
                    name, line = each, call.lineno
        if not name or _put_back(function, name) or _looked_at_first(loop, kept, tree):
            continue
        yield (
            line,
            f"{name} leaves {kept} here, before its transform is asked for: if that has not come yet, the message "
            "is lost. Take it out when its transform is there, or put it back",
        )


def _always(loop: ast.For, call: ast.Call) -> bool:
    return any(isinstance(each, ast.Expr) and each.value is call for each in loop.body)


def _put_back(function: ast.FunctionDef, name: str) -> bool:
    kept = any(
        last_name(call.func) in KEEPS and name in {part for each in call.args for part in _names(each)}
        for call, _ in calls(function)
    )
    return kept or any(
        isinstance(target, ast.Attribute | ast.Subscript) and name in _names(value)
        for target, value in assigned(function)
        if not isinstance(value, ast.Call | ast.BinOp)
    )


def _looked_at_first(loop: ast.AST, kept: str, tree: ast.AST) -> bool:
    return any(f"{kept}[" in unparse(call) for call, _ in calls(loop) if _asks(call, tree))


@slip_of(ast.FunctionDef)
def emptied(function: ast.FunctionDef, tree: ast.AST) -> Words:
    """Find a list that is emptied behind the loop that asks for the transforms of its messages."""
    for loop in (node for node in nodes_of(function, ast.For) if _asks(node, tree)):
        kept = _over(loop)
        later = [node for node in walk(function) if getattr(node, "lineno", 0) > (loop.end_lineno or 0)]
        filled = [call for call, name in calls(function) if name in KEEPS and unparse(call).startswith(f"{kept}.")]
        if not filled or any(call.lineno >= loop.lineno for call in filled):
            continue
        for node in later:
            if node not in function.body and not _in_finally(function, node):
                continue
            text = unparse(node)
            if text == f"{kept}.clear()" or text in {f"{kept} = {empty}" for empty in EMPTY}:
                yield (
                    node,
                    f"this empties {kept}, also of the messages whose transform has not come yet: only those that "
                    "are done may leave it",
                )


def _in_finally(function: ast.FunctionDef, node: ast.AST) -> bool:
    return any(node in each.finalbody for each in nodes_of(function, ast.Try))


@slip
def kept_when_done(tree: ast.AST) -> Iterator[Place]:
    """Find `waiting = [one for one in waiting if self.answer(one)]` where answer() is false without one."""
    false = {
        each.name
        for each in functions(tree)
        if called(each) & ASKED
        and any(
            isinstance(handler, ast.ExceptHandler) and unparse(handler.body[-1]) in ("return False", "return None")
            for handler in walk(each)
        )
        and any(isinstance(node, ast.Return) and unparse(node) == "return True" for node in walk(each))
    }
    for target, value in assigned(tree):
        kept = value.value if isinstance(value, ast.Subscript) else value
        if not isinstance(kept, ast.ListComp) or len(kept.generators) != 1:
            continue
        loop = kept.generators[0]
        if unparse(target) != unparse(loop.iter) or len(loop.ifs) != 1:
            continue
        test = loop.ifs[0]
        if isinstance(test, ast.Call) and last_name(test.func) in false:
            yield (
                test.lineno,
                f"this keeps what {last_name(test.func)}() has answered, where it returns True, and drops what still "
                f"waits for its transform: if not {unparse(test)}",
            )


@slip
def first_for_ever(tree: ast.AST) -> Iterator[Place]:
    """Find a list, or an attribute, whose first message is the only one that is asked for and leaves when answered."""
    for kept, line in _asked_alone(tree).items():
        outside = [each for each in functions(tree) if each.name != "__init__"]
        removals = [node for each in outside for node in walk(each) if _removes(node, kept)]
        text = unparse(tree)
        if len(removals) != 1 or f"len({kept}) >" in text or f"len({kept}) =" in text or "maxlen" in text:
            continue
        if not _on_failure(tree, removals[0]):
            yield (
                line,
                f"only the oldest message, {kept}, is asked for, and it leaves when its transform is there; that of "
                "the very first message is older than all transforms and never comes, so all others wait for it: "
                "ask for each, or drop what is too old",
            )


def _asked_alone(tree: ast.AST) -> dict[str, int]:
    """Return `waiting[0]`, or an attribute that is filled only while it is None, of which transforms are asked for."""
    found: dict[str, int] = {}
    guarded = {
        unparse(target)
        for node in nodes_of(tree, ast.If)
        for target, value in assigned(ast.Module(node.body, []))
        if isinstance(value, ast.Name) and unparse(node.test) in _is_none(unparse(target))
    }
    for function in functions(tree):
        loops = [node for node in nodes_of(function, ast.For)]
        if any(_asks(loop, tree) for loop in loops):
            return {}
        values = {unparse(target): value for target, value in assigned(function)}
        for call, name in calls(function):
            if name not in ASKED:
                continue
            for each in _followed(call, values, STEPS):
                if each.endswith("[0]") or each in guarded:
                    found.setdefault(each, call.lineno)
    return found


def _is_none(name: str) -> tuple[str, ...]:
    return f"{name} is None", f"not {name}", f"{name} == None"


def _followed(node: ast.AST, values: dict[str, ast.expr], steps: int) -> set[str]:
    """Return all names in an expression, and those of what they were assigned."""
    names = _names(node)
    for name in list(names) if steps else ():
        if name in values:
            names |= _followed(values[name], values, steps - 1)
    return names


def _removes(node: ast.AST, kept: str) -> bool:
    owner = kept.removesuffix("[0]")
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
        return unparse(node.func.value) == owner and node.func.attr in REMOVES
    if isinstance(node, ast.Delete):
        return any(unparse(target).startswith(owner) for target in node.targets)
    if isinstance(node, ast.Assign):
        return unparse(node.targets[0]) == owner and (owner != kept or unparse(node.value) in EMPTY)
    return False


def _on_failure(tree: ast.AST, removal: ast.AST) -> bool:
    """Return whether a removal is reached, too, when there is no transform."""
    for node in walk(tree):
        inside = any(each is removal for each in walk(node))
        if isinstance(node, ast.ExceptHandler) and inside:
            return True
        if isinstance(node, ast.Try):
            if any(each is removal for part in node.finalbody for each in walk(part)):
                return True
            goes_on = any(not _ends(handler.body) for handler in node.handlers)
            asks = any(called(part) & ASKED for part in node.body)
            if asks and goes_on and not inside and removal.lineno > node.lineno:  # type: ignore[attr-defined]
                return True
        if isinstance(node, ast.If) and inside:
            test, behind = (
                unparse(node.test),
                any(each is removal for part in node.orelse for each in walk(part)),
            )
            if any(asked in test for asked in ASKED) and (test.startswith("not ") != behind):
                return True
    return False


def _ends(block: list[ast.stmt]) -> bool:
    return isinstance(block[-1], ast.Return | ast.Break | ast.Continue | ast.Raise)


@slip_of(ast.FunctionDef)
def time_of_another(function: ast.FunctionDef) -> Words:
    """Find a loop over messages that asks for each transform at the time of the message that has just come."""
    given = {each.arg for each in function.args.args} - {"self"}
    values = {unparse(target): value for target, value in assigned(function)}
    lists = {
        unparse(call.func.value)
        for call, name in calls(function)
        if name in KEEPS and isinstance(call.func, ast.Attribute) and {unparse(each) for each in call.args} & given
    }
    for loop in nodes_of(function, ast.For):
        if _over(loop) not in lists:
            continue
        each = unparse(loop.target)
        for call, name in calls(loop):
            times = [*call.args[2:3], *(word.value for word in call.keywords if word.arg == "time")]
            names = _followed(times[0], values, STEPS) if name in ASKED and times else set()
            if names & given and each not in names and any("stamp" in one for one in names):
                new = sorted(names & given)[0]
                yield (
                    call,
                    f"this asks for {each}, which waits, at the time of {new}, which has just come and whose "
                    f"transform is not there yet: the time is that of {each}.header.stamp",
                )


@slip
def keyed_by_seconds(tree: ast.AST) -> Iterator[Place]:
    """Find a dictionary of messages whose key is `stamp.sec`, which all messages of one second share."""
    if "nanosec" in unparse(tree):
        return
    for target, value in assigned(tree):
        seconds = isinstance(target, ast.Subscript) and unparse(target.slice).endswith("stamp.sec")
        if isinstance(target, ast.Subscript) and seconds and isinstance(value, ast.Name):
            yield (
                target.lineno,
                f"{unparse(target.slice)} is the same for all messages of one second, so each takes the place "
                "of the one before: (stamp.sec, stamp.nanosec) is a key for each message",
            )
