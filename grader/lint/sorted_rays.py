"""An index into sorted ranges that is taken for the number of a ray; used by `slips.py`."""

from __future__ import annotations

import ast
from collections.abc import Iterator

Place = tuple[int, str]
SORTS = frozenset({"sorted", "sort", "reversed"})  # of Python, and np.sort
FINDS = frozenset({"index", "argmin", "nanargmin"})


def ranks_for_rays(tree: ast.AST) -> Iterator[Place]:
    """Find `enumerate(sorted(ranges))` whose index is multiplied by angle_increment, and the like."""
    for function in (node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)):
        sorted_names = _sorted_names(function)
        ranks = dict(_ranks(function, sorted_names))
        for node in ast.walk(function):
            if not isinstance(node, ast.BinOp) or not isinstance(node.op, ast.Mult):
                continue
            sides = ast.unparse(node.left), ast.unparse(node.right)
            for one, other in (sides, sides[::-1]):
                if one in ranks and "increment" in other:
                    line, what = ranks[one]
                    yield (
                        line,
                        f"{one} is a place in sorted ranges ({what[:50]}): sorting has changed the order, so {one} is "
                        "no longer the number of a ray; sort pairs (range, number of the ray), or take the index of "
                        "the smallest in scan.ranges itself",
                    )
                    return


def _sorted_names(function: ast.FunctionDef) -> set[str]:
    """Return the names of lists of ranges that were sorted, without the numbers of their rays."""
    names = set()
    for node in ast.walk(function):
        if isinstance(node, ast.Assign) and _sorts(node.value, set()):
            names |= {ast.unparse(target) for target in node.targets}
        elif isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
            method = node.value.func
            if isinstance(method, ast.Attribute) and method.attr == "sort" and not node.value.keywords:
                names.add(ast.unparse(method.value))
    pairs = {
        ast.unparse(node.targets[0])
        for node in ast.walk(function)
        if isinstance(node, ast.Assign) and _of_pairs(node.value)
    }
    appended = {
        ast.unparse(node.func.value)
        for node in ast.walk(function)
        if isinstance(node, ast.Call)
        and isinstance(node.func, ast.Attribute)
        and node.func.attr == "append"
        and node.args
        and isinstance(node.args[0], ast.Tuple)
    }
    return names - pairs - appended


def _sorts(node: ast.AST, names: set[str]) -> bool:
    """Return whether an expression is a sorted list of plain ranges."""
    if ast.unparse(node) in names:
        return True
    if not isinstance(node, ast.Call) or ast.unparse(node.func).rpartition(".")[2] not in SORTS - {"reversed"}:
        return False
    return bool(node.args) and not node.keywords and _plain(node.args[0])


def _plain(node: ast.AST) -> bool:
    """Return whether an expression is the ranges of a scan, all or some of them, and nothing beside them."""
    if isinstance(node, ast.ListComp | ast.GeneratorExp):
        return isinstance(node.elt, ast.Name) and _plain(node.generators[0].iter)
    if isinstance(node, ast.Call):
        return ast.unparse(node.func).rpartition(".")[2] in ("list", "array", "asarray") and _plain(node.args[0])
    return isinstance(node, ast.Attribute | ast.Name) and ast.unparse(node).rpartition(".")[2] == "ranges"


def _of_pairs(node: ast.AST) -> bool:
    """Return whether a value is made of pairs, as by a comprehension, zip() or enumerate()."""
    inner = node.args[0] if isinstance(node, ast.Call) and node.args else node
    if isinstance(inner, ast.ListComp | ast.GeneratorExp):
        return isinstance(inner.elt, ast.Tuple)
    return isinstance(inner, ast.Call) and ast.unparse(inner.func) in ("zip", "enumerate")


def _ranks(function: ast.FunctionDef, names: set[str]) -> Iterator[tuple[str, tuple[int, str]]]:
    """Yield each name that holds a place in a sorted list, with the line and the expression it comes from."""
    for node in ast.walk(function):
        if isinstance(node, ast.For | ast.comprehension):
            call, target = node.iter, node.target
            enumerates = isinstance(call, ast.Call) and ast.unparse(call.func) == "enumerate" and bool(call.args)
            if enumerates and isinstance(target, ast.Tuple) and _sorts(call.args[0], names):  # type: ignore[attr-defined]
                yield ast.unparse(target.elts[0]), (call.lineno, ast.unparse(call))
        elif isinstance(node, ast.Assign) and isinstance(node.value, ast.Call):
            found = node.value.func
            if not isinstance(found, ast.Attribute) or found.attr not in FINDS:
                continue
            given = found.value if found.attr == "index" or not node.value.args else node.value.args[0]
            if _sorts(given, names):
                yield ast.unparse(node.targets[0]), (node.lineno, ast.unparse(node.value))


LOOKS = (ranks_for_rays,)
