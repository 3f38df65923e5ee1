"""Two names of one array or list, where each is changed in place as if it were one of its own."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import (
    Place,
    Words,
    assigned,
    calls,
    functions,
    last_name,
    nodes_of,
    unparse,
)
from gz_course.grader.feedback.slips import slip, slip_of

MAKES = frozenset({"zeros", "ones", "full", "empty", "array", "zeros_like", "list", "dict", "set"})
CHANGES = frozenset({"append", "extend", "add", "update", "fill", "insert"})


@slip
def one_array(tree: ast.AST) -> Iterator[Place]:
    """Find `self.hits = self.passes = np.zeros(...)`, and `self.passes = self.hits`, where both are changed."""
    changed = _changed(tree)
    made: set[str] = set()
    for function in (each for each in functions(tree) if each.name == "__init__"):
        for node in nodes_of(function, ast.Assign):
            names = [unparse(target) for target in node.targets]
            if _makes(node.value):
                made |= set(names)
            elif unparse(node.value) in made:
                names.append(unparse(node.value))
            both = [name for name in names if name in changed]
            if len(both) > 1 and (_makes(node.value) or unparse(node.value) in made):
                yield (
                    node.lineno,
                    f"{unparse(node)[:70]} gives one array two names, so what is added to {both[0]} is in "
                    f"{both[1]}, too: make each of its own",
                )


@slip_of(ast.FunctionDef)
def one_local(function: ast.FunctionDef) -> Words:
    """Find `misses = hits = set()` in a function that adds to both by different calls."""
    for node in (each for each in nodes_of(function, ast.Assign) if len(each.targets) > 1):
        names = [each.id for each in node.targets if isinstance(each, ast.Name)]
        new = {unparse(one) for one, _ in assigned(function) if one not in node.targets}
        added = [
            name
            for name in names
            if any(each in CHANGES and unparse(call.func).startswith(f"{name}.") for call, each in calls(function))
        ]
        if _makes(node.value) and len(added) > 1 and not new & set(names):
            yield (
                node,
                f"{unparse(node)[:70]} gives one collection two names, so what is added to {added[0]} is in "
                f"{added[1]}, too: make each of its own",
            )


def _makes(value: ast.expr) -> bool:
    if isinstance(value, ast.BinOp) and isinstance(value.op, ast.Mult):
        return isinstance(value.left, ast.List)
    return isinstance(value, ast.List | ast.Dict) or (isinstance(value, ast.Call) and last_name(value.func) in MAKES)


def _changed(tree: ast.AST) -> set[str]:
    """Return the attributes whose parts are changed in place, in a function of the file that gets them, too."""
    changing = {each.name: _parts_set(each) for each in functions(tree)}
    found = set().union(*changing.values()) if changing else set()
    for call, name in calls(tree):
        if isinstance(call.func, ast.Attribute) and name in CHANGES:
            found.add(unparse(call.func.value))
        if unparse(call.func).endswith("add.at") and call.args:
            found.add(unparse(call.args[0]))
        own = next((each for each in functions(tree) if each.name == name), None)
        if own is not None:
            names = [each.arg for each in own.args.args if each.arg != "self"]
            for parameter, given in zip(names, call.args, strict=False):
                if parameter in changing[own.name]:
                    found.add(unparse(given))
    return {each for each in found if each.startswith("self.")}


def _parts_set(function: ast.FunctionDef) -> set[str]:
    """Return the names of which parts are assigned."""
    found = set()
    for node in nodes_of(function, ast.Subscript):
        whole: ast.expr = node
        while isinstance(whole, ast.Subscript):
            whole = whole.value
        if isinstance(node.ctx, ast.Store):
            found.add(unparse(whole))
    return found
