"""Suspects in the bearings of rays: counted from ray 0 as if it looked ahead, and compared with degrees."""

from __future__ import annotations

import ast
import re

from gz_course.grader.feedback.facts.constants import Number, named_numbers, number
from gz_course.grader.feedback.facts.syntax import Words, assigned, called, children, nodes_of, set_to, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

INCREMENT = "angle_increment"
OFFSETS = re.compile(r"\bangle_m(?:in|ax)\b")
CONVERTS = frozenset({"degrees", "rad2deg", "radians", "deg2rad"})
FEWEST_DEGREES, MOST_DEGREES = 10, 360  # a number of degrees that is no angle in radians; a full turn has 6.3
RADIANS = re.compile(r"\bangle_(?:min|max|increment)\b|\batan2\b|\barctan2\b")


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
