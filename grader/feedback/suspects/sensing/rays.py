"""Suspects in what reads a scan: rays by number, bearings from ray 0, parts of the other side, the farthest."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from gz_course.grader.feedback.facts.constants import Number, named_numbers, number
from gz_course.grader.feedback.facts.syntax import (
    Words,
    assigned,
    called,
    calls,
    children,
    functions,
    last_name,
    nodes_of,
    set_to,
    unparse,
    walk,
)
from gz_course.grader.feedback.suspects import suspicion, suspicion_of
from gz_course.grader.feedback.suspects.about import About, Suspect

BEFORE = ("feedback", "known_places")

COPIES = frozenset({"list", "tuple", "array", "asarray"})
INCREMENT = "angle_increment"
OFFSETS = re.compile(r"\bangle_m(?:in|ax)\b")
CONVERTS = frozenset({"degrees", "rad2deg", "radians", "deg2rad"})
FEWEST_DEGREES, MOST_DEGREES = 10, 360  # a number of degrees that is no angle in radians; a full turn has 6.3
RADIANS = re.compile(r"\bangle_(?:min|max|increment)\b|\batan2\b|\barctan2\b")
Loop = ast.For | ast.comprehension
RAYS = 720.0
OTHER = {"left": "right", "right": "left"}


@suspicion_of(About.RAY)
def by_number(tree: ast.AST) -> Words:
    """Find a ray, or a slice of rays, that is chosen by a number in the program."""
    names = {
        unparse(target)
        for target, value in assigned(tree)
        if isinstance(target, ast.Name) and unparse(_copied(value)).endswith(".ranges")
    }
    for node in nodes_of(tree, ast.Subscript):
        whole = unparse(node.value)
        if not whole.endswith("ranges") and whole not in names:
            continue
        if _numbered(node.slice):
            yield (
                node,
                f"{unparse(node)[:60]} takes a ray by its number: ray i looks to angle_min + i * angle_increment "
                "[rad], and 0 is ahead only if angle_min is 0",
            )


def _copied(value: ast.expr) -> ast.expr:
    """Return what `list(...)` or `np.array(...)` copies, or the value itself."""
    copies = isinstance(value, ast.Call) and last_name(value.func) in COPIES and len(value.args) > 0
    return value.args[0] if copies and isinstance(value, ast.Call) else value


def _numbered(index: ast.expr) -> bool:
    """Return whether an index is made of numbers alone; `[:, None]` adds an axis, and `[::-1]` leaves no ray out."""
    if isinstance(index, ast.Tuple):
        return False
    parts = [index.lower, index.upper] if isinstance(index, ast.Slice) else [index]
    inside = [each for part in parts if part is not None for each in walk(part)]
    names = any(isinstance(each, ast.Name | ast.Attribute | ast.Call) for each in inside)
    return not names and any(isinstance(each, ast.Constant) and isinstance(each.value, int) for each in inside)


@suspicion_of(About.RAY)
def smallest_of_all(tree: ast.AST) -> Words:
    whole = {unparse(target) for target, value in assigned(tree) if unparse(value).endswith(".ranges")}
    for node in nodes_of(tree, ast.Call):
        if last_name(node.func) == "min" and len(node.args) == 1:
            text = unparse(node.args[0])
            if (text.endswith(".ranges") or text in whole) and not node.keywords:
                yield (
                    node,
                    f"{unparse(node)[:60]} is the nearest in any direction, and includes ranges that are "
                    "not valid: choose the rays by their bearing, and those between range_min and range_max",
                )


@suspicion_of(About.BEARING)
def from_ray_zero(tree: ast.Module) -> Words:
    """Find a bearing that is `i * angle_increment`, with no first angle, and the number of a ray without one."""
    if OFFSETS.search(unparse(tree)):
        return
    steps = {INCREMENT} | {
        unparse(target) for target, value in assigned(tree) if unparse(value).endswith(f".{INCREMENT}")
    }
    parent = {child: node for node in walk(tree) for child in children(node)}
    numbers = _numbers_of_rays(tree)
    summed = {
        unparse(side)
        for node in nodes_of(tree, ast.BinOp)
        if isinstance(node.op, ast.Add | ast.Sub | ast.Mod)
        for side in (node.left, node.right)
    } | {unparse(node.target) for node in nodes_of(tree, ast.AugAssign)}
    for node in walk(tree):
        if (by_hand := _degree_for_each_ray(node, numbers)) and not _shifted(node, parent, summed):
            yield (
                by_hand,
                f"{unparse(node)[:60]} takes the number of a ray for its bearing in degrees, counted from ahead: "
                "ray 0 looks to angle_min, and ray i to angle_min + i * angle_increment",
            )
            return
        if not isinstance(node, ast.BinOp):
            continue
        left, right = unparse(node.left), unparse(node.right)
        counted = isinstance(node.op, ast.Mult) and (
            (left in numbers and _is_step(right, steps)) or (right in numbers and _is_step(left, steps))
        )
        found = isinstance(node.op, ast.Div | ast.FloorDiv) and _is_step(right, steps) and "(" not in right
        if not (counted or found) or _shifted(node, parent, summed) or (found and _sum(node.left)):
            continue
        yield (
            node,
            f"{unparse(node)[:60]} counts from ray 0 as if it looked straight ahead: it looks to angle_min, and "
            "ray i to angle_min + i * angle_increment",
        )


def _degree_for_each_ray(node: ast.AST, numbers: set[str]) -> int:
    """Return the line of `i * pi / 180` or `radians(i)` where i counts rays; 0 for anything else."""
    match node:
        case ast.Call(args=[ast.Name(id=name)]) if unparse(node.func).rpartition(".")[2] in ("radians", "deg2rad"):
            return node.lineno if name in numbers else 0
        case ast.BinOp():
            found = re.fullmatch(r"(\w+) \* \(?(?:\w+\.)?pi / 180(?:\.0)?\)?", unparse(node))
            return node.lineno if found and found[1] in numbers else 0
    return 0


def _is_step(text: str, steps: set[str]) -> bool:
    return text in steps or text.endswith(f".{INCREMENT}")


def _numbers_of_rays(tree: ast.AST) -> set[str]:
    """Return the names that count rays in loops."""
    found = set()
    for node in nodes_of(tree, ast.For, ast.comprehension):
        if isinstance(node.iter, ast.Call):
            called = unparse(node.iter.func)
            if called == "enumerate" and isinstance(node.target, ast.Tuple):
                found.add(unparse(node.target.elts[0]))
            elif called in ("range", "np.arange"):
                found.add(unparse(node.target))
    return found


def _sum(node: ast.AST) -> bool:
    return any(isinstance(each, ast.BinOp) and isinstance(each.op, ast.Add | ast.Sub) for each in walk(node))


def _shifted(node: ast.AST, parent: dict[ast.AST, ast.AST], summed: set[str]) -> bool:
    """Return whether something is added to an expression, at once or to the name that it is given."""
    above: ast.AST | None = node
    while above is not None and not isinstance(above, ast.stmt):
        above = parent.get(above)
        if isinstance(above, ast.BinOp) and isinstance(above.op, ast.Add | ast.Sub | ast.Mod):
            return True
        if isinstance(above, ast.Subscript):
            return False
    if isinstance(above, ast.Assign):
        return any(unparse(target) in summed for target in above.targets)
    return False


@suspicion_of(About.ANGLE)
def degrees_beside_radians(tree: ast.Module) -> Words:
    """Find an angle of a scan, or of atan2, that is compared with a number of degrees or subtracted from one."""
    if called(tree) & CONVERTS or re.search(r"\b(?:180|57)\b", unparse(tree)):
        return
    known, names = named_numbers(tree), _radians(tree)
    for node in walk(tree):
        pairs: list[tuple[ast.expr, ast.expr]] = []
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub):
            pairs = [(node.left, node.right)]
        elif isinstance(node, ast.Compare):
            pairs = list(zip([node.left, *node.comparators], node.comparators, strict=False))
        for pair in pairs:
            for angle, limit in (pair, pair[::-1]):
                value = number(limit, known)
                if value is None or not FEWEST_DEGREES <= abs(value) <= MOST_DEGREES or not _is_angle(angle, names):
                    continue
                yield (
                    node,
                    f"{unparse(node)[:60]}: {_shown(limit, value)} are degrees, and {unparse(angle)[:40]} is "
                    "in radians, as all angles of a scan are: math.radians() converts degrees",
                )
                return


def _shown(node: ast.expr, value: Number) -> str:
    text = unparse(node)
    return f"{value:g}" if isinstance(node, ast.Constant | ast.UnaryOp) else f"the {value:g} of {text}"


def _is_angle(node: ast.expr, names: set[str]) -> bool:
    if isinstance(node, ast.Call) and unparse(node.func) in ("abs", "math.fabs", "np.abs") and node.args:
        return _is_angle(node.args[0], names)
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub):
        return _is_angle(node.left, names) or _is_angle(node.right, names)
    return unparse(node) in names


def _radians(tree: ast.AST) -> set[str]:
    """Return the names that are given angles in radians somewhere in the file."""
    return {
        name
        for name, given in set_to(tree).items()
        if any(RADIANS.search(unparse(each)) and not _is_index(each) for each in given)
    }


def _is_index(node: ast.expr) -> bool:
    """Return whether a value is a number of rays, not an angle."""
    return bool(called(node) & {"int", "round", "len", "floor", "ceil"}) or any(
        isinstance(each, ast.BinOp) and isinstance(each.op, ast.Div | ast.FloorDiv) for each in walk(node)
    )


@suspicion_of(About.FARTHEST)
def largest_range(tree: ast.Module) -> Words:
    """Find the largest of the ranges of a scan in a node that steers, where nothing takes the smallest."""
    if "angular.z" not in unparse(tree):
        return
    for function in functions(tree):
        lists = set(_of_ranges(function))
        given = [(call, name, unparse(call.args[0])) for call, name in calls(function) if len(call.args) == 1]
        if any(name in ("min", "nanmin", "argmin", "sorted", "sort") for _, name, _ in given):
            continue
        for call, name, text in given:
            if name in ("max", "nanmax") and (text in lists or text.partition("[")[0].endswith(".ranges")):
                yield (
                    call,
                    f"{unparse(call)[:60]} takes the farthest of the ranges: the distance from a wall is that of "
                    "its nearest point, min(...)",
                )


def _of_ranges(function: ast.FunctionDef) -> Iterator[str]:
    """Yield the names of lists that are filled from the ranges of a scan."""
    for node in nodes_of(function, ast.For):
        if ".ranges" in unparse(node.iter):
            for call, name in calls(node):
                if name == "append":
                    yield unparse(call.func).rpartition(".")[0]
    for target, value in assigned(function):
        if isinstance(value, ast.ListComp) and any(".ranges" in unparse(loop.iter) for loop in value.generators):
            yield unparse(target)


@suspicion
def other_side(tree: ast.Module) -> Iterator[Suspect]:
    """Find a part for one side that looks to the other, in a scan that begins behind the robot."""
    if ".ranges" not in unparse(tree):
        return
    known = dict(named_numbers(tree))
    for target, value in assigned(tree):
        if isinstance(value, ast.Call) and unparse(value.func) == "len" and value.args:
            known[unparse(target)] = RAYS
    for side, block in _sides(tree):
        for node in (each for statement in block for each in walk(statement)):
            if not isinstance(node, ast.Subscript) or not isinstance(node.slice, ast.Slice) or node.slice.step:
                continue
            ends = _share(node.slice.lower, known, 0.0), _share(node.slice.upper, known, 1.0)
            if None in ends or ends == (0.0, 1.0):
                continue
            start, end = (360 * share - 180 for share in ends if share is not None)
            if (start + end) * (1 if side == "left" else -1) <= -80 and end > start:
                yield (
                    node.lineno,
                    About.PART.of(side),
                    f"{unparse(node)[:60]} is taken for the {side}, and looks to the {OTHER[side]}, from "
                    f"{start:.0f} to {end:.0f} degrees: angle_min is -pi, so ray 0 looks behind, the ray at a quarter "
                    "to the right, at a half ahead and at three quarters to the left",
                )


def _sides(tree: ast.AST) -> Iterator[tuple[str, list[ast.stmt]]]:
    """Yield the side of each branch that is taken on one side only, and its statements."""
    for node in nodes_of(tree, ast.If):
        if not node.orelse:
            continue
        match node.test:
            case ast.Compare(ops=[ast.Eq()], comparators=[ast.Constant(value="left" | "right" as side)]):
                yield from ((side, node.body), (OTHER[side], node.orelse))
            case ast.Compare(
                left=ast.Name(id="s" | "sign" | "side"), ops=[ast.Gt()], comparators=[ast.Constant(value=0)]
            ):
                yield from (("left", node.body), ("right", node.orelse))


def _share(node: ast.expr | None, known: dict[str, float], absent: float) -> float | None:
    """Return the place of a ray as a share of all rays; None if it is not one."""
    if node is None:
        return absent
    if "len(" in unparse(node):
        node = _Lengths().visit(ast.parse(unparse(node), mode="eval")).body
    elif not any(isinstance(each, ast.Name) and known.get(each.id) == RAYS for each in walk(node)):
        return None
    value = number(node, known)
    return None if value is None or not 0 <= value <= RAYS else value / RAYS


class _Lengths(ast.NodeTransformer):
    """Puts a number in the place of each len(...)."""

    def visit_Call(self, node: ast.Call) -> ast.AST:
        return ast.Constant(value=RAYS) if unparse(node.func) == "len" else node
