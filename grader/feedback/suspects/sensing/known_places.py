"""Suspects in what keeps the places of things that were seen: which of the points are the same thing."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import (
    Words,
    assigned,
    called,
    functions,
    last_name,
    nodes_of,
    set_to,
    unparse,
    walk,
)
from gz_course.grader.feedback.suspects import suspicion, suspicion_of
from gz_course.grader.feedback.suspects.about import About, Suspect
from gz_course.grader.feedback.suspects.sensing.gyroscopes import assigned_once, expanded
from gz_course.grader.feedback.suspects.steering.headings import SINES

ADDS = frozenset({"append", "add", "insert"})
ROUNDS = frozenset({"round", "around", "rint", "floor", "int", "trunc", "ceil"})
WHOLE = frozenset({"array", "asarray", "min", "map", "cdist", "filter", "sorted", "stack", "vstack"})
TURNS = SINES | {"exp", "rect", "Rotation", "from_euler", "rotation_matrix", "dot", "matmul"}


def kept(tree: ast.AST) -> Iterator[tuple[ast.FunctionDef, ast.Call, str]]:
    """Yield the calls that add a place of two or more numbers to an attribute: function, call, attribute."""
    spoken = {unparse(call.args[0]) for call in _calls(tree, {"len"}) if call.args}
    for function in nodes_of(tree, ast.FunctionDef):
        for call in _calls(function, ADDS):
            name = unparse(call.func).rpartition(".")[0]
            if name in spoken and name.startswith("self.") and call.args:
                yield function, call, name


def _calls(tree: ast.AST, names: frozenset[str] | set[str]) -> Iterator[ast.Call]:
    for node in nodes_of(tree, ast.Call):
        if last_name(node.func) in names:
            yield node


@suspicion_of(About.SAME)
def only_one_compared(tree: ast.AST) -> Words:
    """Find a place that is compared with the last, or the first, known one, where nothing goes through all."""
    for function, call, name in kept(tree):
        if _goes_through(tree, function, name):
            continue
        for node in nodes_of(function, ast.Subscript):
            if unparse(node.value) != name:
                continue
            index = unparse(node.slice)
            if index in ("-1", "0") and node.lineno <= call.lineno:
                which = "last" if index == "-1" else "first"
                yield (
                    node,
                    f"a new point is compared with {name}[{index}] only, the {which} one found, so a post that is seen "
                    f"again later counts again: compare it with all of {name}",
                )


def _goes_through(tree: ast.AST, function: ast.FunctionDef, name: str) -> bool:
    """Say whether all known places are looked at, in the function that adds one or in one that publishes nothing."""
    for each in functions(tree):
        if each is not function and ".publish(" in unparse(each):
            continue
        loops = nodes_of(each, ast.For, ast.While, ast.comprehension)
        if any(name in unparse(loop.test if isinstance(loop, ast.While) else loop.iter) for loop in loops):
            return True
        if any(name in unparse(call) for call in _calls(each, WHOLE)):
            return True
    return False


@suspicion_of(About.SAME)
def nearest_one_compared(tree: ast.AST) -> Words:
    """Find a place that is compared with the known one nearest to the robot, not with the one nearest to it."""
    for function, call, name in kept(tree):
        loops = [node for node in nodes_of(function, ast.For, ast.comprehension)]
        if any(name in unparse(loop.iter) for loop in loops):
            continue
        for chosen in _calls(function, {"min", "sorted"}):
            keys = [each.value for each in chosen.keywords if each.arg == "key"]
            differs = any(isinstance(node, ast.Sub) for key in keys for node in walk(key))
            own = keys and (
                differs or not isinstance(keys[0], ast.Lambda) or called(keys[0]) - {"hypot", "norm", "sqrt"}
            )
            of = unparse(chosen.args[0]) if chosen.args else ""
            if of == name and keys and not own and chosen.lineno <= call.lineno:
                yield (
                    chosen,
                    f"{unparse(chosen)[:70]} is the known post nearest to the robot, and a new point is compared "
                    f"with that one only: compare it with all of {name}",
                )


@suspicion_of(About.SAME)
def by_number(tree: ast.AST) -> Words:
    """Find a place that is new if few are known, where nothing compares it with those that are."""
    adding = {function.name for function, _, _ in kept(tree)}
    for function, call, name in kept(tree):
        compared = _goes_through(tree, function, name)
        inner = {id(node) for node in walk(function)}
        for node in nodes_of(tree, ast.If):
            tests = [each for each in nodes_of(node.test, ast.Compare)]
            sides = [{unparse(each.left), *map(unparse, each.comparators)} for each in tests]
            if not any(
                f"len({name})" in each and any("len(" in side for side in each - {f"len({name})"}) for each in sides
            ):
                continue  # a limit of how many there may be is none of that
            done = walk(ast.Module(node.body, []))
            calls_it = any(isinstance(each, ast.Call) and last_name(each.func) in adding for each in done)
            if (any(each is call for each in done) and not compared) or (calls_it and id(node) not in inner):
                yield (
                    node,
                    f"{unparse(node.test)[:60]} decides by how many posts are known whether one is new: a post is "
                    f"new if its place is far from all places in {name}",
                )


@suspicion
def rounded(tree: ast.AST) -> Iterator[Suspect]:
    """Find places that are the same if their rounded numbers are, or only if their numbers are equal."""
    for function, call, name in kept(tree):
        in_set = unparse(call.func).endswith(".add")
        if not (in_set or f"in {name}" in unparse(function)) or _goes_through(tree, function, name):
            continue
        yield from _equal(call.lineno, call, expanded(call.args[0], assigned_once(function)))
    spoken = {unparse(call.args[0]) for call in _calls(tree, {"len"}) if call.args}
    for function in nodes_of(tree, ast.FunctionDef):
        for target, _ in assigned(function):
            name = unparse(target.value) if isinstance(target, ast.Subscript) else ""
            if isinstance(target, ast.Subscript) and name in spoken and not _goes_through(tree, function, name):
                yield from _equal(target.lineno, target, expanded(target.slice, assigned_once(function)))


def _equal(line: int, code: ast.expr, key: ast.expr) -> Iterator[Suspect]:
    """Yield what is wrong with a place as a key."""
    text = unparse(code)[:70]
    if called(key) & ROUNDS or "//" in unparse(key):
        yield (
            line,
            About.SAME,
            f"{text} keeps rounded numbers: points of one post near the border between two of them are rounded to "
            "different ones, so it counts again; compare distances with those that are known",
        )
    elif isinstance(key, ast.Tuple) and called(key) <= SINES:
        yield (
            line,
            About.SAME,
            f"{text}: two measurements of one post are never equal to the last digit, so each counts again; compare "
            "distances with those that are known",
        )


@suspicion_of(About.SAME)
def one_is_far(tree: ast.AST) -> Words:
    """Find places that are new as soon as one known place is far away, instead of all."""
    for function, call, name in kept(tree):
        for node in walk(function):
            if isinstance(node, ast.For) and name in unparse(node.iter):
                tests = [each for each in nodes_of(node, ast.If) if _far(each.test)]
                if any(call in walk(each) for test in tests for each in test.body):
                    yield (
                        call,
                        f"{unparse(call)[:50]} is done in the loop, for each known post that is far away: a post "
                        "is new only if all known ones are, which is known after the loop",
                    )
            if isinstance(node, ast.Call) and last_name(node.func) == "any" and name in unparse(node):
                inside = node.args[0] if node.args else None
                if isinstance(inside, ast.GeneratorExp | ast.ListComp) and _far(inside.elt) and _guards(function, node):
                    yield (
                        node,
                        f"{unparse(node)[:60]} holds as soon as one known post is far away: a post is new only if "
                        "all are, all(...)",
                    )


@suspicion_of(About.SAME)
def near_all(tree: ast.AST) -> Words:
    """Find places that are new if they are near all known ones."""
    for function, call, name in kept(tree):
        for node in nodes_of(function, ast.If):
            if call not in walk(ast.Module(node.body, [])):
                continue
            test = node.test
            inside = (
                test.args[0] if isinstance(test, ast.Call) and last_name(test.func) == "all" and test.args else None
            )
            if not isinstance(inside, ast.GeneratorExp | ast.ListComp) or name not in unparse(inside):
                continue
            if isinstance(inside.elt, ast.Compare) and _far(_turned_over(inside.elt)):
                yield (
                    node,
                    f"{unparse(test)[:60]} holds for a point that is near all known posts, and a post is new if "
                    "it is far from all: > in place of <",
                )


def _turned_over(test: ast.Compare) -> ast.Compare:
    """Return a comparison that holds where the given one does not."""
    other = {ast.Lt: ast.GtE(), ast.LtE: ast.Gt(), ast.Gt: ast.LtE(), ast.GtE: ast.Lt()}
    return ast.Compare(test.left, [other.get(type(each), each) for each in test.ops], test.comparators)


def _far(test: ast.expr) -> bool:
    """Say whether a test holds for what is far away: a distance greater than something."""
    if not isinstance(test, ast.Compare) or len(test.ops) != 1:
        return False
    left, right = unparse(test.left), unparse(test.comparators[0])
    distance = re.compile("hypot|dist|norm|sqrt")
    greater = isinstance(test.ops[0], ast.Gt | ast.GtE)
    return bool(distance.search(left if greater else right)) and isinstance(
        test.ops[0], ast.Gt | ast.GtE | ast.Lt | ast.LtE
    )


def _guards(function: ast.AST, call: ast.Call) -> bool:
    """Say whether a call is itself the condition of an `if`, so that what follows is done if it holds."""
    return any(isinstance(node, ast.If) and node.test is call for node in walk(function))


@suspicion_of(About.UNTURNED)
def unturned(tree: ast.AST) -> Words:
    """Find places that are kept in a file in which nothing is turned."""
    if called(tree) & TURNS or any(isinstance(node.op, ast.MatMult) for node in nodes_of(tree, ast.BinOp)):
        return
    for function, call, _ in kept(tree):
        if _is_one_field(function, call.args[0]):
            continue
        yield (
            call,
            f"{unparse(call)[:60]} keeps points as the camera sees them, and the robot turns: turn each by the "
            "heading at which it was seen",
        )


def _is_one_field(function: ast.FunctionDef, added: ast.expr) -> bool:
    """Say whether what is added is one field of something, such as the rate of a gyroscope, and so no place."""
    given = set_to(function).get(unparse(added), [])
    return isinstance(added, ast.Attribute) or (len(given) == 1 and isinstance(given[0], ast.Attribute))
