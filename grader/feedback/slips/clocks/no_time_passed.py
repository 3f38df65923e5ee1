"""Differences that are always 0, because what is subtracted was given the new value before."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping

from gz_course.grader.feedback.facts.syntax import Place, assigned, children, functions, last_name, unparse, walk
from gz_course.grader.feedback.slips import slip


@slip
def updated_too_early(tree: ast.AST) -> Iterator[Place]:
    """Find `self.last = now` and after it `now - self.last`, where neither gets another value in between."""
    own = {function.name: function for function in functions(tree)}
    for function in own.values():
        yield from _in_block(function.body, {}, own)


def _in_block(
    body: list[ast.stmt], kept: dict[str, tuple[str, int]], own: Mapping[str, ast.FunctionDef]
) -> Iterator[Place]:
    """Go through statements in their order; `kept` holds which name is a copy of which, and since which line.

    `own` are the functions of the file into which a statement may pass a value; empty if they are not looked into.
    """
    for statement in body:
        inner = [getattr(statement, name, []) for name in ("body", "orelse", "finalbody")]
        heads = [each for each in children(statement) if isinstance(each, ast.expr)]
        for node in (each for head in heads for each in walk(head)):
            if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Sub):
                left, right = unparse(node.left), unparse(node.right)
                for one, other in ((right, left), (left, right)):
                    known = kept.get(one) or ("", 0)
                    if known[0] == other:
                        yield (
                            node.lineno,
                            f"{unparse(node)[:60]} is always 0, because line {known[1]} has made {one} the same as "
                            f"{other}: do that after the difference is taken",
                        )
                        return
            elif isinstance(node, ast.Call) and last_name(node.func) in own:
                yield from _passed_on(node, own[last_name(node.func)], kept)
        if isinstance(statement, ast.FunctionDef | ast.ClassDef | ast.For | ast.While | ast.AsyncFunctionDef):
            kept.clear()  # what a loop assigns may come before what it reads
            continue
        for part in inner:
            if isinstance(part, list):
                yield from _in_block(part, dict(kept), own)
        changed = {unparse(target) for target, _ in assigned(statement)}
        for name in [name for name, (of, _) in kept.items() if {name, of} & changed]:
            del kept[name]
        if isinstance(statement, ast.Assign):
            for target, value in assigned(statement):
                if isinstance(target, ast.Attribute) and isinstance(value, ast.Name) and value.id not in changed:
                    kept[unparse(target)] = (value.id, statement.lineno)


def _passed_on(call: ast.Call, function: ast.FunctionDef, kept: dict[str, tuple[str, int]]) -> Iterator[Place]:
    """Go through a function that is called with what an attribute of self is a copy of."""
    names = [each.arg for each in function.args.args if each.arg != "self"]
    given = {unparse(value): name for name, value in zip(names, call.args, strict=False)}
    inner = {
        kept_name: (given[of], line)
        for kept_name, (of, line) in kept.items()
        if of in given and kept_name.startswith("self.")
    }
    if inner:
        yield from _in_block(function.body, inner, {})
