"""Conditions that hold always or never: of two bounds, of None, of a state in another spelling, of what stays."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping

from gz_course.grader.feedback.facts.constants import Number, named_numbers, number
from gz_course.grader.feedback.facts.syntax import Place, Words, assigned, is_none, nodes_of, unparse, walk
from gz_course.grader.feedback.slips import slip, slip_of
from gz_course.grader.feedback.slips.language.unreached import blocks
from gz_course.sim.did_you_mean import nearest_name

ABOVE, BELOW = (ast.Gt, ast.GtE), (ast.Lt, ast.LtE)
MIRRORED = {ast.Gt: ast.Lt, ast.GtE: ast.LtE, ast.Lt: ast.Gt, ast.LtE: ast.GtE}
NEAR = 0.75  # how alike two names of one state are
FEWEST = 3  # letters of a name


@slip
def of_two_bounds(tree: ast.AST) -> Iterator[Place]:
    """Find `x > 0 or x < 5`, which always holds, and `x > 5 and x < 0`, which never does."""
    numbers = named_numbers(tree)
    for node in walk(tree):
        match node:
            case ast.Compare(left=low, ops=[ast.Lt() | ast.LtE(), ast.Lt() | ast.LtE()], comparators=[_, high]):
                if _order(low, high, numbers) > 0:
                    code = unparse(node)[:70]
                    yield node.lineno, f"{code} never holds: the first bound is larger than the second one"
        if not isinstance(node, ast.BoolOp) or len(node.values) != 2:
            continue
        bounds = [bound for each in node.values if (bound := _bound(each))]
        if len(bounds) != 2 or bounds[0][0] != bounds[1][0] or bounds[0][1] == bounds[1][1]:
            continue
        (name, _, low), (_, _, high) = sorted(bounds, key=lambda bound: not bound[1])  # what is above `low` first
        order = _order(low, high, numbers)
        code = unparse(node)[:70]
        if isinstance(node.op, ast.Or) and order < 0:
            yield (
                node.lineno,
                f"{code} holds for every {name}, because one of the two always does: and joins two bounds",
            )
        elif isinstance(node.op, ast.And) and order > 0:
            yield node.lineno, f"{code} never holds: no {name} is above the larger bound and below the smaller one"


@slip_of(ast.Compare, ast.BoolOp)
def the_same_bound(node: ast.Compare | ast.BoolOp) -> Words:
    """Find `low <= x <= low`, which only one value meets, or none."""
    match node:
        case ast.Compare(left=low, ops=[one, other], comparators=[_, high]) if type(one) in MIRRORED:
            same = (type(one) in ABOVE) == (type(other) in ABOVE) and unparse(low) == unparse(high)
        case ast.BoolOp(op=ast.And(), values=[one, other]):
            bounds = [bound for each in (one, other) if (bound := _bound(each))]
            texts = [(bound[0], unparse(bound[2])) for bound in bounds]
            same = len(texts) == 2 and texts[0] == texts[1] and bounds[0][1] != bounds[1][1]
        case _:
            return
    if same:
        code = unparse(node)[:70]
        yield f"{code} has the same bound twice, so no other value than that is between: one is wrong"


def _bound(node: ast.expr) -> tuple[str, bool, ast.expr] | None:
    """Return what is compared, whether it is to lie above, and with what; None for other conditions."""
    if not isinstance(node, ast.Compare) or len(node.ops) != 1:
        return None
    left, kind, right = node.left, type(node.ops[0]), node.comparators[0]
    if kind not in MIRRORED:
        return None
    if isinstance(left, ast.Constant) or _is_bound(left):
        left, kind, right = right, MIRRORED[kind], left
    return unparse(left), kind in ABOVE, right


def _is_bound(node: ast.expr) -> bool:
    return isinstance(node, ast.Attribute) and node.attr in ("range_min", "range_max")


def _order(low: ast.expr, high: ast.expr, numbers: Mapping[str, Number]) -> int:
    """Return -1 if the first bound is the smaller one, 1 if it is the larger one, 0 if nobody knows."""
    one, other = number(low, numbers), number(high, numbers)
    if one is not None and other is not None:
        return (one > other) - (one < other)
    names = [getattr(each, "attr", "") for each in (low, high)]
    return {("range_min", "range_max"): -1, ("range_max", "range_min"): 1}.get((names[0], names[1]), 0)


@slip
def none_for_ever(tree: ast.AST) -> Iterator[Place]:
    """Find `if self.start is None: self.begin = now` in a file where nothing else than None is put into self.start."""
    values: dict[str, list[ast.expr]] = {}
    for target, value in assigned(tree):
        values.setdefault(unparse(target).rpartition(".")[2], []).append(value)
    others = {
        unparse(target).rpartition(".")[2]
        for node in walk(tree)
        for target in [getattr(node, "target", None), *[getattr(each, "optional_vars", None) for each in _items(node)]]
        if isinstance(target, ast.expr) and not isinstance(node, ast.AnnAssign)
    }
    for node in walk(tree):
        name = _asked(node.test) if isinstance(node, ast.If) else ""
        last = name.rpartition(".")[2]
        if not name.startswith("self.") or last in others or "setattr" in unparse(tree):
            continue
        given = values.get(last, [])
        if not given or not all(is_none(each) for each in given):
            continue
        instead = [unparse(target) for each in node.body for target, _ in assigned(each)]  # type: ignore[attr-defined]
        if instead:
            yield (
                node.lineno,  # type: ignore[attr-defined]
                f"{name} stays None, because the code below sets {instead[0]} and not {name}: so this holds in "
                "every call; use one name for both",
            )


def _items(node: ast.AST) -> list[ast.withitem]:
    return node.items if isinstance(node, ast.With) else []


def _asked(test: ast.expr) -> str:
    """Return the name of `NAME is None` and `not NAME`; empty for other conditions."""
    match test:
        case ast.Compare(left=left, ops=[ast.Is() | ast.Eq()], comparators=[ast.Constant(value=None)]):
            return unparse(left)
        case ast.UnaryOp(op=ast.Not(), operand=ast.Attribute() as operand):
            return unparse(operand)
    return ""


@slip
def none_again(tree: ast.AST) -> Iterator[Place]:
    """Find `start = None` and then `if start is None:` in one block, with nothing in between that sets the name."""
    for block in blocks(tree):
        none: dict[str, int] = {}
        for statement in block:
            name = _asked(statement.test) if isinstance(statement, ast.If) else ""
            if name in none:
                yield (
                    statement.lineno,
                    f"{name} is None here in every call, because line {none[name]} makes it None each time: what is "
                    "to last from call to call is set once, outside of the function that is called (self.NAME)",
                )
                return
            changed = {unparse(target) for target, _ in assigned(statement)}
            changed |= {unparse(each.target) for each in walk(statement) if hasattr(each, "target")}
            none = {each: line for each, line in none.items() if each not in changed}
            match statement:
                case ast.Assign(targets=[ast.Name(id=made)], value=ast.Constant(value=None)):
                    none[made] = statement.lineno


@slip_of(ast.If)
def implied(node: ast.If, tree: ast.AST) -> Words:
    """Find `elif x >= 5:` below `if x >= 0:`, which leaves nothing for it."""
    numbers = named_numbers(tree)
    if len(node.orelse) != 1 or not isinstance(node.orelse[0], ast.If):
        return
    other = node.orelse[0]
    one, two = _bound(node.test), _bound(other.test)
    if one is None or two is None or one[:2] != two[:2]:
        return
    wide, narrow = number(one[2], numbers), number(two[2], numbers)
    if wide is None or narrow is None or wide == narrow:
        return
    if (wide < narrow) == one[1]:
        yield (
            other,
            f"elif {unparse(other.test)[:60]}: is never reached: where it holds, {unparse(node.test)[:60]} "
            "holds, too, and the first condition that holds is taken; ask for the narrower one first",
        )


@slip_of(ast.FunctionDef, first=True)
def deadline_of_now(function: ast.FunctionDef) -> Words:
    """Find `deadline = now + Duration(seconds=5)` and then `now < deadline` in one call."""
    ends: dict[str, tuple[int, str]] = {}
    for statement in function.body:
        match statement:
            case ast.Assign(targets=[target], value=ast.BinOp(left=begin, op=ast.Add())):
                ends[unparse(target)] = statement.lineno, unparse(begin)
                continue
        for node in nodes_of(statement, ast.Compare):
            if len(node.ops) != 1 or type(node.ops[0]) not in MIRRORED:
                continue
            sides = [unparse(node.left), unparse(node.comparators[0])]
            for one, other in (sides, sides[::-1]):
                if one in ends and ends[one][1] == other and "now" in other:
                    yield (
                        ends[one][0],
                        f"{one} is computed again from {other} in every call, so it is always ahead, and line "
                        f"{node.lineno} always gives the same: set it once, in the first call",
                    )


@slip_of(ast.ClassDef)
def flag_of_its_own_block(owner: ast.ClassDef) -> Words:
    """Find `if late and not self.moving:` where self.moving begins as True and only that block changes it."""
    changes: dict[str, list[tuple[ast.expr, ast.expr]]] = {}
    for target, value in assigned(owner):
        changes.setdefault(unparse(target), []).append((target, value))
    for node in nodes_of(owner, ast.If):
        if not isinstance(node.test, ast.BoolOp):
            continue
        if not isinstance(node.test.op, ast.And):
            continue
        inside = {id(each) for statement in node.body for each in walk(statement)}
        for part in node.test.values:
            negated = isinstance(part, ast.UnaryOp) and isinstance(part.op, ast.Not)
            name = unparse(part.operand if isinstance(part, ast.UnaryOp) else part)
            others = [value for target, value in changes.get(name, []) if id(target) not in inside]
            if len(others) == 1 and len(changes[name]) > 1 and isinstance(others[0], ast.Constant):
                first = others[0].value
                if isinstance(first, bool) and first == negated:
                    yield (
                        node,
                        f"the code below this condition never runs: {name} is {first} from the start, and only "
                        "these lines change it",
                    )


@slip_of(ast.FunctionDef)
def returns_when_there(function: ast.FunctionDef) -> Words:
    """Find `if self.x is not None: return` before lines that use parts of `self.x`, which is None there."""
    for place, node in enumerate(function.body):
        if not isinstance(node, ast.If) or node.orelse or unparse(node.body[-1]) not in ("return", "return None"):
            continue
        for name in _there(node.test):
            if _uses(function.body[place + 1 :], name):
                yield (
                    node,
                    f"{function.name} returns here when {name} is there, and the lines below use it, where it is "
                    f"None: if {name} is None",
                )


def _there(test: ast.expr) -> Iterator[str]:
    """Yield the attributes of self of which one that is not None makes a condition true."""
    if isinstance(test, ast.BoolOp) and isinstance(test.op, ast.Or):
        for each in test.values:
            yield from _there(each)
    elif isinstance(test, ast.Compare) and isinstance(test.ops[0], ast.IsNot):
        name, none = unparse(test.left), unparse(test.comparators[0])
        yield from [name] if none == "None" and name.startswith("self.") else []


def _uses(body: list[ast.stmt], name: str) -> bool:
    """Return whether statements use parts of an attribute before one of them sets it."""
    for statement in body:
        nodes = list(walk(statement))
        if any(isinstance(node, ast.Attribute) and _stores(node, name) for node in nodes):
            return False
        for node in nodes:
            parts = isinstance(node, ast.Attribute | ast.Subscript) and unparse(node.value) == name
            unpacked = (
                isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Tuple) and unparse(node.value) == name
            )
            if parts or unpacked:
                return True
    return False


def _stores(node: ast.Attribute, name: str) -> bool:
    return isinstance(node.ctx, ast.Store) and unparse(node) == name


@slip
def other_spelling(tree: ast.AST) -> Iterator[Place]:
    """Find `self.state = 'Stop'` where only `self.state == 'stop'` is asked for."""
    given: dict[str, dict[str, int]] = {}
    unknown: set[str] = set()
    for target, value in assigned(tree):
        name = unparse(target)
        if isinstance(value, ast.Constant) and isinstance(value.value, str):
            given.setdefault(name, {}).setdefault(value.value, target.lineno)
        else:
            unknown.add(name)
    elsewhere = {name.rpartition(".")[2] for name in given.keys() | unknown if not name.startswith("self.")}
    asked: dict[str, dict[str, int]] = {}
    equal: set[tuple[str, str]] = set()
    for node in walk(tree):
        match node:
            case ast.Compare(left=left, ops=[ast.Eq() | ast.NotEq()], comparators=[ast.Constant(value=str(text))]):
                asked.setdefault(unparse(left), {}).setdefault(text, node.lineno)
                if isinstance(node.ops[0], ast.Eq):
                    equal.add((unparse(left), text))
    for name in given.keys() & asked.keys() - unknown:
        for text, line in asked[name].items():
            unasked = [each for each in given[name] if each not in asked[name] and len(each) >= FEWEST]
            if text not in given[name] and (near := _alike(text, unasked)):
                yield (
                    line,
                    f"{name} is never {text!r}: line {given[name][near]} sets it to {near!r}, which is spelt otherwise",
                )
            elif text in given[name] or (name, text) not in equal or name.rpartition(".")[2] in elsewhere:
                continue
            elif name.startswith("self.") and given[name].keys() - asked[name].keys():
                values = ", ".join(repr(each) for each in list(given[name])[:4])
                yield line, f"{name} is never {text!r}, so this condition never holds: it is set to {values}"


def _alike(text: str, names: list[str]) -> str:
    same = next((each for each in names if each.casefold() == text.casefold()), "")
    return same or nearest_name(text, names, NEAR) or ""


def _numbers(test: ast.expr) -> set[str]:
    """Return the names in a comparison of names and numbers; nothing if it holds anything else."""
    if not isinstance(test, ast.Compare) or isinstance(test.ops[0], ast.Is | ast.IsNot | ast.In | ast.NotIn):
        return set()
    sides = [test.left, *test.comparators]
    names = {each.id for each in sides if isinstance(each, ast.Name)}
    numbers = [each for each in sides if isinstance(each, ast.Constant) and isinstance(each.value, int | float)]
    return names if numbers and len(names) + len(numbers) == len(sides) else set()


def _leaves(loop: ast.While) -> bool:
    """Return whether a loop is left in another way than by a cancellation."""
    asked = [each for each in nodes_of(loop, ast.If) if "cancel" in unparse(each.test)]
    cancelled = {id(node) for each in asked for part in each.body for node in walk(part)}
    ways = (ast.Break, ast.Return, ast.Raise, ast.Yield, ast.Await)
    return any(isinstance(each, ways) and id(each) not in cancelled for each in walk(loop))


@slip_of(ast.FunctionDef)
def never_changes(function: ast.FunctionDef) -> Words:
    """Find `while left > 0.1:` where left was computed above the loop, and nowhere in it."""
    shared = {n for each in nodes_of(function, ast.Global, ast.Nonlocal) for n in each.names}
    stores = [n for n in nodes_of(function, ast.Name) if isinstance(n.ctx, ast.Store)]
    for loop in nodes_of(function, ast.While):
        names = _numbers(loop.test)
        inside = {id(node) for node in walk(loop)}
        above = [n for n in stores if n.id in names and n.lineno < loop.lineno and id(n) not in inside]
        changed = {n.id for n in stores if id(n) in inside} | shared
        if names and not names & changed and {n.id for n in above} == names and not _leaves(loop):
            last = max(above, key=lambda node: node.lineno)
            yield (
                loop,
                f"nothing in this loop changes {last.id}, which line {last.lineno} has computed, so "
                f"`{unparse(loop.test)[:60]}` stays as it is: compute it again in every iteration",
            )
