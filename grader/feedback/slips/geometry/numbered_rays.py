"""Places in filtered, sorted or reversed ranges that are taken for the numbers of rays."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Words, assigned, last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.slips import slip_of

COPIES = frozenset({"list", "array", "asarray", "tuple"})
MASKS = frozenset({"isfinite", "isnan", "isinf", "logical_and", "logical_or", "logical_not"})
ADVICE = (
    "the angle belongs to the index in scan.ranges: compute the angles of all rays first, then leave the same rays out "
    "of ranges and angles"
)
FINDS = frozenset({"index", "argmin", "nanargmin"})
ELEMENTWISE = frozenset({"hypot", "abs", "sqrt", "fabs"})
# What was done to the ranges -> what it does to the numbers of their rays.
DONE = {
    "sorted": "sorting has changed the order",
    "filtered": "what was left out has moved the others up",
    "reversed": "it counts from the last ray",
}


@slip_of(ast.FunctionDef, first=True)
def numbered_after_filtering(function: ast.FunctionDef) -> Words:
    """Find `angle_increment * np.arange(len(good))`, where `good` holds only some of the ranges, and the like."""
    kinds = _Kinds(function)
    for node in walk(function):
        match node:
            case ast.BinOp(op=ast.Mult(), left=left, right=right):
                for one, other in ((left, right), (right, left)):
                    name = kinds.numbered(one) if "increment" in unparse(other) else ""
                    if name:
                        yield node, _words(one, name, kinds.left_out(name, node.lineno))
            case ast.Call(args=[first, last, number, *_]) if last_name(node.func) == "linspace":
                ends = unparse(first) + unparse(last)
                if "angle_min" in ends and "angle_max" in ends and (name := kinds.length_of(number)):
                    yield node, _words(node, name, kinds.left_out(name, node.lineno))


def _words(node: ast.expr, name: str, line: int) -> str:
    return (
        f"{unparse(node)[:60]} numbers only the rays that line {line} has left in {name}, and those behind one "
        f"that was left out get the angle of another ray; {ADVICE}"
    )


class _Kinds:
    """What the names of a function hold: `plain` ranges, `filtered` ones, a `mask`, or the `numbers` of some rays."""

    def __init__(self, function: ast.FunctionDef) -> None:
        self.known: list[tuple[int, str, str]] = []  # line, name, kind
        nodes = nodes_of(function, ast.Assign, ast.For)
        for node in sorted(nodes, key=lambda each: each.lineno):
            if isinstance(node, ast.For):
                self._loop(node)
                continue
            for target in node.targets:
                pairs = [(target, node.value)]
                if isinstance(target, ast.Tuple) and isinstance(node.value, ast.Tuple):
                    pairs = list(zip(target.elts, node.value.elts, strict=False))
                found = [(node.lineno, unparse(name), self._kind(value, node.lineno)) for name, value in pairs]
                self.known += found

    def _loop(self, loop: ast.For) -> None:
        """Note a list that gets some of the ranges, and the index of `for i in range(len(good))`."""
        if isinstance(loop.target, ast.Name) and self.numbered(loop.iter):
            self.known.append((loop.lineno, loop.target.id, f"numbers {self.numbered(loop.iter)}"))
        if self._kind(loop.iter, loop.lineno) != "plain":
            return
        for test in loop.body:
            for each in test.body if isinstance(test, ast.If) else ():
                match each:
                    case ast.Expr(
                        value=ast.Call(func=ast.Attribute(value=of, attr="append"), args=[ast.Name() as kept])
                    ):
                        if unparse(kept) == unparse(loop.target):
                            self.known.append((each.lineno, unparse(of), "filtered"))

    def _before(self, name: str, line: int) -> tuple[int, str]:
        """Return where a name got its last value before a line, and of which kind that is."""
        found = [(at, kind) for at, known, kind in self.known if known == name and at < line]
        return found[-1] if found else (0, "plain" if name.rpartition(".")[2] == "ranges" else "")

    def left_out(self, name: str, line: int) -> int:
        """Return the line in which a name got only some of the ranges."""
        return self._before(name, line)[0]

    def _kind(self, node: ast.expr, line: int) -> str:
        match node:
            case ast.Name() | ast.Attribute():
                return self._before(unparse(node), line)[1]
            case ast.Call(args=[_, given]) if last_name(node.func) == "filter":
                return "filtered" if self._kind(given, line) in ("plain", "filtered") else ""
            case ast.Call(args=[given, *_]) if last_name(node.func) in COPIES:
                return self._kind(given, line)
            case ast.ListComp(elt=elt, generators=[loop]) if unparse(elt) == unparse(loop.target):
                kind = self._kind(loop.iter, line)
                return "filtered" if kind == "plain" and loop.ifs else kind
            case ast.Subscript(value=of, slice=index) if self._is_mask(index, line):
                return "filtered" if self._kind(of, line) in ("plain", "filtered") else ""
        if self._is_mask(node, line):
            return "mask"
        return f"numbers {name}" if (name := self.numbered(node)) else ""

    def _is_mask(self, node: ast.expr, line: int) -> bool:
        match node:
            case ast.Compare() | ast.BinOp(op=ast.BitAnd() | ast.BitOr()):
                return True
            case ast.UnaryOp(op=ast.Invert(), operand=inner):
                return self._is_mask(inner, line)
            case ast.Call():
                return last_name(node.func) in MASKS
            case ast.Name():
                return self._before(node.id, line)[1] == "mask"
        return False

    def numbered(self, node: ast.expr) -> str:
        """Return the filtered list that `np.arange(len(good))`, or a name that holds that, numbers; else nothing."""
        match node:
            case ast.Call(args=[number]) if last_name(node.func) in ("arange", "range"):
                return self.length_of(number)
            case ast.Call(args=[given]) if last_name(node.func) in COPIES:
                return self.numbered(given)
            case ast.Name():
                return self._before(node.id, node.lineno)[1].partition("numbers ")[2]
        return ""

    def length_of(self, node: ast.expr) -> str:
        """Return the filtered list of which an expression is the length; empty if it is something else."""
        match node:
            case ast.Call(func=ast.Name(id="len"), args=[of]):
                pass
            case ast.Attribute(value=of, attr="size") | ast.Subscript(value=ast.Attribute(value=of, attr="shape")):
                pass
            case _:
                return ""
        return unparse(of) if self._kind(of, node.lineno) == "filtered" else ""


@slip_of(ast.For, first=True)
def left_out_before_the_next_angle(loop: ast.For) -> Words:
    """Find `angle += scan.angle_increment` behind a `continue` of its loop, or below an `if` that looks at the ray."""
    if not any(each in unparse(loop.iter) for each in ("ranges", "zip(", "enumerate(", "range(")):
        return
    left: ast.If | None = None
    for statement in loop.body:
        steps = [each for each in walk(statement) if _steps(each)]
        above = statement if isinstance(statement, ast.If) and not _steps(statement) else None
        if steps and (left is not None or (above is not None and len(steps) < 2 and not above.orelse)):
            test = left if left is not None else above
            assert test is not None and isinstance(steps[0], ast.AugAssign)
            yield (
                steps[0],
                f"{unparse(steps[0])} is not reached for a ray that line {test.lineno} leaves out, so all rays behind "
                "it get the angle of another one: the angle grows with each ray, also with those that are left out",
            )
        if steps:
            break
        if isinstance(statement, ast.If) and any(isinstance(each, ast.Continue) for each in statement.body):
            left = left or statement


def _steps(node: ast.AST) -> bool:
    return isinstance(node, ast.AugAssign) and "angle_increment" in unparse(node.value)


@slip_of(ast.FunctionDef, first=True)
def places_for_rays(function: ast.FunctionDef) -> Words:
    """Find `enumerate(sorted(ranges))` whose index is multiplied by angle_increment, and the like."""
    found = dict(_places(function, dict(_changed_lists(function))))
    stored = [node.id for node in nodes_of(function, ast.Name) if _is_store(node)]
    for node in nodes_of(function, ast.BinOp):
        if not isinstance(node.op, ast.Mult):
            continue
        sides = unparse(node.left), unparse(node.right)
        for one, other in (sides, sides[::-1]):
            if one in found and "increment" in other and stored.count(one) == 1:
                line, what, how = found[one]
                yield (
                    line,
                    f"{one} is a place in {how} ranges ({what[:50]}): {DONE[how]}, so {one} is not the number of a "
                    "ray; keep pairs (range, number of the ray), or look for the index in scan.ranges itself",
                )


def _is_store(node: ast.Name) -> bool:
    return isinstance(node.ctx, ast.Store)


def _changed_lists(function: ast.FunctionDef) -> Iterator[tuple[str, str]]:
    """Yield the names of lists of plain ranges that are not as the scan has them, and what was done to them."""
    for node in walk(function):
        match node:
            case ast.Assign(targets=[target], value=value) if how := _done(value, {}):
                yield unparse(target), how
            case ast.Expr(value=ast.Call(func=ast.Attribute(value=of, attr="sort" | "reverse" as attr))) if _plain(of):
                yield unparse(of), "sorted" if attr == "sort" else "reversed"
            case ast.For(body=[ast.If(body=inner)]) if name := _ranges_of(node):
                for each in inner:
                    match each:
                        case ast.Expr(
                            value=ast.Call(func=ast.Attribute(value=of, attr="append"), args=[ast.Name(id=a)])
                        ):
                            if a == name:
                                yield unparse(of), "filtered"


def _ranges_of(loop: ast.For) -> str:
    """Return the name of the single range in a loop over ranges; empty if it is another loop."""
    return loop.target.id if isinstance(loop.target, ast.Name) and _plain(loop.iter) else ""


def _done(node: ast.AST, names: dict[str, str]) -> str:
    """Return what was done to plain ranges in an expression; empty if nothing, or if it is another expression."""
    if unparse(node) in names:
        return names[unparse(node)]
    match node:
        case ast.Call(args=[given, *_], keywords=[]):
            name = unparse(node.func).rpartition(".")[2]
            inner = _done(given, names)
            if name in COPIES:
                return inner
            if name in ("sorted", "sort") and (inner or _plain(given)):
                return "sorted"
            if name == "reversed" and (inner or _plain(given)):
                return "reversed"
        case ast.ListComp(elt=ast.Name(id=elt), generators=[ast.comprehension(target=ast.Name(id=of)) as loop]):
            if elt == of and _plain(loop.iter):
                return "filtered" if loop.ifs else ""
        case ast.Subscript(value=of, slice=ast.Compare() | ast.Call() | ast.BinOp(op=ast.BitAnd())) if _plain(of):
            return "filtered" if not isinstance(node.slice, ast.Call) or "isfinite" in unparse(node.slice) else ""
        case ast.Subscript(value=of, slice=ast.Slice(lower=None, upper=None, step=ast.UnaryOp(op=ast.USub()))):
            return "reversed" if _plain(of) else ""
    return ""


def _plain(node: ast.AST) -> bool:
    """Return whether an expression is the ranges of a scan, and nothing beside them."""
    if isinstance(node, ast.Call):
        return unparse(node.func).rpartition(".")[2] in COPIES and bool(node.args) and _plain(node.args[0])
    return isinstance(node, ast.Attribute | ast.Name) and unparse(node).rpartition(".")[2] == "ranges"


def _places(function: ast.FunctionDef, names: dict[str, str]) -> Iterator[tuple[str, tuple[int, str, str]]]:
    """Yield each name that holds a place in such a list, with the line, the expression and what was done to it."""
    for node in walk(function):
        match node:
            case (
                ast.For(iter=call, target=ast.Tuple(elts=[index, *_]))
                | ast.comprehension(iter=call, target=ast.Tuple(elts=[index, *_]))
            ):
                match call:
                    case ast.Call(func=ast.Name(id="enumerate"), args=[given]) if how := _done(given, names):
                        yield unparse(index), (call.lineno, unparse(call), how)
            case ast.Assign(targets=[target], value=ast.Call(func=ast.Attribute(attr=name, value=owner)) as call):
                given = owner if name == "index" or not call.args else call.args[0]
                if name in FINDS and (how := _done(given, names)):
                    yield unparse(target), (node.lineno, unparse(call), how)


@slip_of(ast.FunctionDef, first=True)
def places_in_masked(function: ast.FunctionDef) -> Words:
    """Find `angles[np.argmin(ranges[valid])]`: the place counts in what is left, and angles has all rays."""
    masked: dict[str, str] = {}
    found: dict[str, tuple[str, str]] = {}
    for node in walk(function):
        for target, value in assigned(node) if isinstance(node, ast.Assign) else ():
            name = unparse(target)
            if mask := _mask(value, masked):
                masked[name] = mask
            if isinstance(value, ast.Call) and _finds(value) and (mask := _mask(value.args[0], masked)):
                found[name] = (unparse(value), mask)
    for name, line in _times_increment(function):
        if name in found:
            what, mask = found[name]
            yield (
                line,
                f"{name} is a place among those that {mask[:30]} has left ({what[:50]}), not the number of a ray: "
                "compute the angles of all rays, and leave the same ones out of both",
            )
    for node in nodes_of(function, ast.Subscript):
        of, place = unparse(node.value), node.slice
        what, mask = found.get(unparse(place), ("", ""))
        if isinstance(place, ast.Call) and _finds(place):
            what, mask = unparse(place), _mask(place.args[0], masked)
        whole = isinstance(node.value, ast.Name) or of.endswith(".ranges")
        if mask and whole and of not in masked and isinstance(node.ctx, ast.Load):
            yield (
                node,
                f"{unparse(node)[:60]}: {what[:50]} is a place among those that {mask[:30]} has left, and {of} "
                f"has all rays, so it is another ray; use {of}[{mask[:30]}]",
            )


def _times_increment(function: ast.FunctionDef) -> Iterator[tuple[str, int]]:
    """Yield each factor of an angle_increment, with its line."""
    for node in nodes_of(function, ast.BinOp):
        if isinstance(node.op, ast.Mult):
            sides = unparse(node.left), unparse(node.right)
            yield from ((one, node.lineno) for one, other in (sides, sides[::-1]) if other.endswith("angle_increment"))


def _finds(call: ast.Call) -> bool:
    return unparse(call.func).rpartition(".")[2] in ("argmin", "nanargmin", "argmax") and len(call.args) == 1


def _mask(node: ast.expr, masked: dict[str, str]) -> str:
    """Return by which mask an array is only a part, such as `ok` of `ranges[ok]`; empty if it is whole."""
    text = unparse(node)
    if isinstance(node, ast.Call) and last_name(node.func) in ELEMENTWISE and node.args:
        masks = {_mask(each, masked) for each in node.args}
        return masks.pop() if len(masks) == 1 else ""
    if isinstance(node, ast.Subscript):
        part = node.slice
        name = isinstance(part, ast.Name) and not part.id.startswith(("i", "k", "n", "j"))
        return unparse(part) if name or isinstance(part, ast.Compare) else ""
    return masked.get(text, "")
