"""Rays that are numbered after some were left out, as if the numbers were still those of the scan."""

from __future__ import annotations

import ast

from gz_course.grader.feedback.facts.syntax import Words, last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.slips import slip_of

COPIES = frozenset({"list", "array", "asarray", "tuple"})
MASKS = frozenset({"isfinite", "isnan", "isinf", "logical_and", "logical_or", "logical_not"})
ADVICE = (
    "the angle belongs to the index in scan.ranges: compute the angles of all rays first, then leave the same rays out "
    "of ranges and angles"
)


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
