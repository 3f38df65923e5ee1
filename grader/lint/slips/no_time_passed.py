"""Differences that are always 0, because what is subtracted was given the new value before."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.lint.syntax import Place, assigned, functions


def updated_too_early(tree: ast.AST) -> Iterator[Place]:
    """Find `self.last = now` and after it `now - self.last`, where neither gets another value in between."""
    for function in functions(tree):
        yield from _in_block(function.body, {})


def _in_block(body: list[ast.stmt], kept: dict[str, tuple[str, int]]) -> Iterator[Place]:
    """Go through statements in their order; `kept` holds which name is a copy of which, and since which line."""
    for statement in body:
        inner = [getattr(statement, name, []) for name in ("body", "orelse", "finalbody")]
        heads = [each for each in ast.iter_child_nodes(statement) if isinstance(each, ast.expr)]
        for node in (each for head in heads for each in ast.walk(head)):
            if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Sub):
                left, right = ast.unparse(node.left), ast.unparse(node.right)
                known = kept.get(right) or ("", 0)
                if known[0] == left:
                    yield (
                        node.lineno,
                        f"{ast.unparse(node)[:60]} is always 0, because line {known[1]} has made {right} the same as "
                        f"{left}: do that after the difference is taken",
                    )
                    return
        if isinstance(statement, ast.FunctionDef | ast.ClassDef | ast.For | ast.While | ast.AsyncFunctionDef):
            kept.clear()  # what a loop assigns may come before what it reads
            continue
        for part in inner:
            if isinstance(part, list):
                yield from _in_block(part, dict(kept))
        changed = {ast.unparse(target) for target, _ in assigned(statement)}
        for name in [name for name, (of, _) in kept.items() if {name, of} & changed]:
            del kept[name]
        if isinstance(statement, ast.Assign):
            for target, value in assigned(statement):
                if isinstance(target, ast.Attribute) and isinstance(value, ast.Name) and value.id not in changed:
                    kept[ast.unparse(target)] = (value.id, statement.lineno)


LOOKS = (updated_too_early,)
