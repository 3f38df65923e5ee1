"""Numbers that an array cannot hold, or a share of 255 never is: fractions in whole numbers, counters in bytes.

`a[i, j] += 0.4` and `a[cells] = a[cells] + 0.4` convert the sum when it is stored. `a[cells] += 0.4`, of several cells,
raises an error, as `a += 0.4` does.

Source: https://numpy.org/doc/stable/user/basics.indexing.html, assigning values to indexed arrays
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping

from gz_course.grader.feedback.facts.constants import Number, named_numbers, number
from gz_course.grader.feedback.facts.syntax import (
    Place,
    assigned,
    called,
    functions,
    last_name,
    nodes_of,
    set_to,
    unparse,
    walk,
)
from gz_course.grader.feedback.slips import slip
from gz_course.grader.feedback.slips.language.names import calls_of_own, parameters

OF_BYTES = (255, 256)
SAME = frozenset({"astype", "copy", "squeeze", "transpose", "split", "moveaxis", "dsplit", "asarray", "array"})
STEPS = 4  # assignments and calls that hand a picture on, at most
NUMPY = ("np", "numpy")
FILLED = {"zeros": 1, "ones": 1, "empty": 1, "full": 2, "array": 1, "zeros_like": 1, "full_like": 2}  # place of dtype
WHOLE = re.compile(r"(?:np\.|numpy\.)?u?int(?:8|16|32|64|c|p|_)?|[ui][1248]|[bBhHiIlL]")
SMALL = re.compile(r"(?:np\.|numpy\.|['\"])(?P<unsigned>u)?int8\b")
KEEPS_FRACTIONS = frozenset({"max", "min", "maximum", "minimum", "clip", "abs", "where", "fmax", "fmin"})


@slip
def shares_as_bytes(tree: ast.AST) -> Iterator[Place]:
    """Find comparisons such as `red > 50` that no share of 255 ever fulfils."""
    names = _shares(tree) if called(tree) & {"imgmsg_to_cv2", "frombuffer"} else set()
    known = named_numbers(tree) if names else {}
    for node in walk(tree) if names else ():
        if not isinstance(node, ast.Compare) or len(node.ops) != 1:
            continue
        left, right = node.left, node.comparators[0]
        if isinstance(node.ops[0], ast.Lt | ast.LtE):
            left, right = right, left
        elif not isinstance(node.ops[0], ast.Gt | ast.GtE):
            continue
        limit = number(right, known)
        if limit is not None and limit > 1 and _is_share(left, names):
            yield (
                node.lineno,
                f"{unparse(node)[:60]} never holds: {unparse(left)[:40]} was divided by 255, so it is between 0 and 1",
            )


def _shares(tree: ast.AST) -> set[str]:
    """Return the names that hold nothing but colours that were divided by 255."""
    given: dict[str, list[ast.expr]] = {}
    for target, value in assigned(tree):
        for each in target.elts if isinstance(target, ast.Tuple) else [target]:
            given.setdefault(unparse(each), []).append(value)
    for function, made in calls_of_own(tree):
        for call in made:
            for name, value in zip(parameters(function), call.args, strict=False):
                if unparse(value) != name:
                    given.setdefault(name, []).append(value)
    loops = [unparse(node.target) for node in nodes_of(tree, ast.For, ast.comprehension)]
    names: set[str] = set()
    for _ in range(STEPS):
        names |= {name for name, values in given.items() if all(_is_share(each, names) for each in values)}
    return names - set(loops)


def _is_share(node: ast.expr, names: set[str]) -> bool:
    match node:
        case ast.BinOp(op=ast.Div(), right=ast.Constant(value=whole)):
            return whole in OF_BYTES
        case ast.Name() | ast.Attribute():
            return unparse(node) in names
        case ast.Subscript(value=value):
            return _is_share(value, names)
        case ast.Call(func=ast.Attribute(value=owner) as method) if last_name(method) in SAME:
            return any(_is_share(each, names) for each in (owner, *node.args[:1]))
    return False


@slip
def fractions_cut_off(tree: ast.AST) -> Iterator[Place]:
    """Find `odds[cell] += 0.9`, or `odds[cell] = odds[cell] - 0.4`, where `odds` is an array of whole numbers."""
    values, names = set_to(tree), named_numbers(tree)
    arrays = {name: made for name, made in _whole_arrays(values, names).items() if made is not None}
    if not arrays:
        return
    given = _given(tree)
    for function in functions(tree):
        local, parameters = set_to(function), {each.arg for each in function.args.args}
        for node in walk(function):
            target: ast.expr
            if isinstance(node, ast.AugAssign) and isinstance(node.op, ast.Add | ast.Sub):
                target, added = node.target, [node.value]
            elif isinstance(node, ast.Assign) and len(node.targets) == 1:
                target, added = node.targets[0], []
            else:
                continue
            name = _array(target)
            if name not in arrays or (name not in local and name in parameters):
                continue
            old = {name, *(own for own, made in local.items() if any(_array(each) == name for each in made))}
            if isinstance(node, ast.Assign):
                added = list(_added(node.value, old))
            parts = [fraction for each in added for fraction in _fractions(each, function, local, names, given)]
            if parts:
                made = arrays[name]
                step = next((each for each in parts if abs(each) < 1), parts[0])
                yield (
                    node.lineno,
                    f"{name} is an array of whole numbers (line {made.lineno}: `{unparse(made)[:60]}`), so "
                    f"`{unparse(node)[:60]}` cannot keep the fraction of {step:g}"
                    f"{', and 0 stays 0' if abs(step) < 1 else ''}: make the array with dtype=float",
                )
                return


@slip
def counters_that_wrap(tree: ast.AST) -> Iterator[Place]:
    """Find `hits[cell] += 1` where `hits` is an array of one byte for each number, and nothing limits it."""
    values = set_to(tree)
    arrays = {
        name: (made, SMALL.search(unparse(made)))
        for name, made in _whole_arrays(values, named_numbers(tree)).items()
        if made is not None
    }
    small = {name: (made, bool(kind["unsigned"])) for name, (made, kind) in arrays.items() if kind}
    text = unparse(tree)
    given = _given(tree) if small else {}
    for function in functions(tree) if small else ():
        parameters = [each.arg for each in function.args.args if each.arg != "self"]
        for node in nodes_of(function, ast.AugAssign):
            if not isinstance(node.op, ast.Add):
                continue
            name = _array(node.target)
            names = [name]
            if name in parameters:
                names = [unparse(each) for each in given.get((function.name, parameters.index(name)), [])]
            counted = next((each for each in names if each in small and not _limited(text, each)), "")
            if counted and isinstance(number(node.value, {}), int):
                made, unsigned = small[counted]
                last, then = (255, 0) if unsigned else (127, -128)
                yield (
                    node.lineno,
                    f"{counted} is an array of bytes (line {made.lineno}: `{unparse(made)[:60]}`), which end at "
                    f"{last}: one more is {then}, so what is counted often begins again: make the array with dtype=int",
                )
                return


def _limited(text: str, name: str) -> bool:
    """Return whether a text limits the numbers of an array, or asks for how large they are."""
    array = re.escape(name)
    return bool(
        re.search(rf"(?:clip|min|minimum|maximum|max)\([^()]*{array}\b", text)
        or re.search(rf"{array}(?:\[[^]]*\])? (?:<|<=|>=) \d{{2,}}", text)
    )


def _whole_arrays(values: Mapping[str, list[ast.expr]], names: Mapping[str, Number]) -> dict[str, ast.expr | None]:
    """Return what makes each array of whole numbers; None for a name that stands for something else, too."""
    found: dict[str, ast.expr | None] = {}
    for _ in range(3):  # arrays like arrays
        for name, made in values.items():
            if made and all(_is_whole(each, found, names) for each in made):
                found[name] = made[0]
    return found


def _is_whole(made: ast.expr, known: Mapping[str, ast.expr | None], names: Mapping[str, Number]) -> bool:
    """Return whether an expression makes an array of whole numbers."""
    if not isinstance(made, ast.Call) or not isinstance(made.func, ast.Attribute):
        return False
    name, owner = made.func.attr, unparse(made.func.value)
    if name == "reshape":
        return _is_whole(made.func.value, known, names)
    if name == "astype":
        return bool(made.args) and _means_whole(made.args[0])
    if owner not in NUMPY or name not in FILLED:
        return False
    kind = next((each.value for each in made.keywords if each.arg == "dtype"), None)
    if kind is None and len(made.args) > FILLED[name]:
        kind = made.args[FILLED[name]]
    if kind is not None:
        return _means_whole(kind)
    if name == "full":
        filled = made.args[1] if len(made.args) > 1 else None
        return isinstance(number(filled, names), int)
    return name.endswith("_like") and bool(made.args) and known.get(unparse(made.args[0])) is not None


def _means_whole(kind: ast.expr) -> bool:
    said = kind.value if isinstance(kind, ast.Constant) else unparse(kind)
    return isinstance(said, str) and WHOLE.fullmatch(said) is not None


def _array(node: ast.AST) -> str:
    """Return the name of the array that is indexed, empty if nothing is."""
    base = node
    while isinstance(base, ast.Subscript):
        base = base.value
    return unparse(base) if base is not node and isinstance(base, ast.Name | ast.Attribute) else ""


def _added(value: ast.expr, old: set[str]) -> Iterator[ast.expr]:
    """Yield what is added to an old number of the array in an expression that does not round the sum itself."""
    match value:
        case ast.BinOp(left=left, op=ast.Add() | ast.Sub(), right=right):
            for one, other in ((left, right), (right, left)):
                if _array(one) in old or unparse(one) in old:
                    yield other
                else:
                    yield from _added(one, old)
        case ast.Call() if last_name(value.func) in KEEPS_FRACTIONS:
            for each in value.args:
                yield from _added(each, old)
        case ast.IfExp(body=body, orelse=orelse):
            yield from (*_added(body, old), *_added(orelse, old))


def _given(tree: ast.AST) -> dict[tuple[str, int], list[ast.expr]]:
    """Return what calls give to each function at each place."""
    found: dict[tuple[str, int], list[ast.expr]] = {}
    for node in nodes_of(tree, ast.Call):
        for place, each in enumerate(node.args):
            found.setdefault((last_name(node.func), place), []).append(each)
    return found


def _fractions(
    added: ast.expr,
    function: ast.FunctionDef,
    local: Mapping[str, list[ast.expr]],
    names: Mapping[str, Number],
    given: Mapping[tuple[str, int], list[ast.expr]],
) -> Iterator[float]:
    """Yield the numbers with a fraction that are added, through a name of the function or its parameter."""
    choices = [added.body, added.orelse] if isinstance(added, ast.IfExp) else [added]
    if isinstance(added, ast.Name):
        choices += local.get(added.id, [])
        parameters = [each.arg for each in function.args.args if each.arg != "self"]
        if added.id in parameters:
            choices += given.get((function.name, parameters.index(added.id)), [])
    for choice in choices:
        for each in (choice.body, choice.orelse) if isinstance(choice, ast.IfExp) else (choice,):
            value = number(each, names)
            if value is not None and value != int(value):
                yield float(value)
