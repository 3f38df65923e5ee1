"""Limits of a value that are exchanged with each other, or with the value."""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable, Iterator, Mapping

from gz_course.grader.feedback.facts.constants import named_numbers, number
from gz_course.grader.feedback.facts.syntax import Place, Words, calls, functions, last_name, set_to, unparse, walk
from gz_course.grader.feedback.slips import slip, slip_of
from gz_course.grader.feedback.slips.language.names import calls_of_own, parameters

Values = Mapping[str, float]
COMPARED: dict[type[ast.cmpop], Callable[[float, float], bool]] = {
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
}
FAR = 1000.0  # a value beyond all limits
CLIP = ast.parse("def clip(value, low, high):\n    return min(high, max(low, value))").body[0]
OTHER = {"min": "max", "max": "min"}
LIMITS = 2  # arguments of min and of max


@slip
def value_as_limit(tree: ast.AST) -> Iterator[Place]:
    """Find calls of an own function that limits, or of `np.clip`, that limit a number by what should be limited."""
    known, locals_of = named_numbers(tree), _values_in_functions(tree)
    assert isinstance(CLIP, ast.FunctionDef)
    clips = [call for call, name in calls(tree) if name == "clip" and _of_numpy(call)]
    limiting = [(function, given) for function, given in calls_of_own(tree) if _limits(function)]
    for function, given in [*limiting, (CLIP, clips)]:
        names = parameters(function)
        for call in given:
            arguments = dict(zip(names, call.args, strict=False))
            arguments.update({word.arg: word.value for word in call.keywords if word.arg in names})
            fixed = {name: number(value, known) for name, value in arguments.items()}
            numbers = {name: float(value) for name, value in fixed.items() if value is not None}
            open_names = [name for name, value in fixed.items() if value is None]
            if len(arguments) != len(names) or len(open_names) != 1 or _works(function, numbers, open_names[0]):
                continue
            if function is CLIP and open_names == ["value"]:
                continue  # `limits.py` says that its limits are exchanged
            if len(names) > 2 and sum(numbers.values()) != 0:
                continue  # a constant may well be limited by something that changes: only -1.5 and 1.5 are limits
            if len(names) == 2 and not _either_sign(arguments[open_names[0]], locals_of.get(id(call), {})):
                continue
            first = f" (line {function.lineno})" if function is not CLIP else ""
            prefix = f"{unparse(call.func)}" if function is CLIP else function.name
            yield (
                call.lineno,
                f"{_shortened(call)} does not limit {unparse(arguments[open_names[0]])[:50]}: its arguments "
                f"are in the wrong order, it is {prefix}({', '.join(names)}){first}",
            )


def _shortened(call: ast.Call) -> str:
    """Return a call with the end left out of each long argument."""
    texts = [unparse(each) for each in call.args]
    return f"{unparse(call.func)}({', '.join(text if len(text) < 40 else f'{text[:30]}...' for text in texts)})"


def _of_numpy(call: ast.Call) -> bool:
    return (
        isinstance(call.func, ast.Attribute) and last_name(call.func.value) in ("np", "numpy") and len(call.args) == 3
    )


def _limits(function: ast.FunctionDef) -> bool:
    """Say whether a function, called in some order, limits one of its parameters by the others."""
    names = parameters(function)
    if len(names) == 2:
        return any(_works(function, {limit: 1.5}, value) for limit, value in (names, names[::-1]))
    if len(names) != 3:
        return False
    for value in names:
        low, high = (name for name in names if name != value)
        if any(_works(function, {low: a, high: b}, value) for a, b in ((-1.5, 1.0), (1.0, -1.5))):
            return True
    return False


def _works(function: ast.FunctionDef, numbers: Values, value: str) -> bool:
    """Say whether the function returns the value between its limits, and the limits beyond."""
    if len(numbers) == 1:
        high = abs(next(iter(numbers.values())))
        low = -high
    else:
        low, high = sorted(numbers.values())
    middle = (low + high) / 2 + 0.01 * (high - low)
    expected = {-FAR: low, FAR: high, middle: middle}
    return all(_result(function, {**numbers, value: given}) == wanted for given, wanted in expected.items())


def _result(function: ast.FunctionDef, values: dict[str, float]) -> float | None:
    """Return what a function of comparisons, `min` and `max` returns; None if it is made of anything else."""
    try:
        return _run(function.body, values)
    except (LookupError, TypeError):
        return None


def _run(block: list[ast.stmt], values: dict[str, float]) -> float | None:
    for statement in block:
        match statement:
            case ast.Return(value=ast.expr() as value):
                return _number(value, values)
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                values[name] = _number(value, values)
            case ast.If(test=ast.Compare(left=left, ops=[op], comparators=[right]), body=body, orelse=orelse):
                chosen = COMPARED[type(op)](_number(left, values), _number(right, values))
                if (result := _run(body if chosen else orelse, values)) is not None:
                    return result
            case ast.Expr(value=ast.Constant()):
                pass
            case _:
                raise LookupError
    return None


def _number(node: ast.expr, values: Values) -> float:
    match node:
        case ast.Name(id=name):
            return values[name]
        case ast.Constant(value=int() | float() as value):
            return float(value)
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return -_number(operand, values)
        case ast.Call(func=ast.Name(id="min" | "max" | "float" as name), args=args):
            given = [_number(each, values) for each in args]
            return min(given) if name == "min" else max(given) if name == "max" else given[0]
        case ast.Call(func=ast.Attribute(attr="clip"), args=[value, low, high]):
            return min(_number(high, values), max(_number(low, values), _number(value, values)))
    raise LookupError


def _either_sign(node: ast.expr, local: Mapping[str, list[ast.expr]], depth: int = 2) -> bool:
    """Say whether an expression may well be negative: a sum or a difference, or a name that was given one."""
    if isinstance(node, ast.Name) and depth and len(local.get(node.id, [])) == 1:
        return _either_sign(local[node.id][0], local, depth - 1)
    if any(isinstance(each, ast.Call) and last_name(each.func) in ("abs", "hypot") for each in walk(node)):
        return False
    return any(isinstance(each, ast.BinOp) and isinstance(each.op, ast.Add | ast.Sub) for each in walk(node))


def _values_in_functions(tree: ast.AST) -> dict[int, dict[str, list[ast.expr]]]:
    """Return, for each call, the values that the names of its function are given."""
    found: dict[int, dict[str, list[ast.expr]]] = {}
    for function in functions(tree):
        values = set_to(function)
        found.update({id(call): values for call, _ in calls(function)})
    return found


@slip_of(ast.Call)
def exchanged(call: ast.Call, tree: ast.AST) -> Words:
    """Find `min(-most, max(most, value))`, which is always `-most`, and `np.clip(value, most, -most)`."""
    known = named_numbers(tree)
    name = last_name(call.func)
    if name == "clip" and len(call.args) == LIMITS + 1 and _below(call.args[2], call.args[1], known):
        yield f"{unparse(call)[:60]} has its limits exchanged: the lower one comes first, clip(value, low, high)"
    if name not in OTHER or len(call.args) != LIMITS or call.keywords:
        return
    for outer, inner in (call.args, call.args[::-1]):
        if not isinstance(inner, ast.Call) or last_name(inner.func) != OTHER[name] or len(inner.args) != LIMITS:
            continue
        for bound in inner.args:
            pair = (outer, bound) if name == "min" else (bound, outer)
            if _below(*pair, known):
                yield (
                    f"{unparse(call)[:60]} is always {unparse(outer)}, whatever the value is: its limits "
                    "are exchanged, it must be max(low, min(high, value))"
                )


def _below(low: ast.expr, high: ast.expr, known: dict[str, int | float]) -> bool:
    """Say whether one limit is certainly below the other: numbers, or a name with a minus and the same without."""
    first, second = number(low, known), number(high, known)
    if first is not None and second is not None:
        return first < second
    negative = isinstance(low, ast.UnaryOp) and isinstance(low.op, ast.USub)
    return negative and unparse(low) == f"-{unparse(high)}" and isinstance(high, ast.Name | ast.Attribute)
