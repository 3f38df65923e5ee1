"""A flag that lets nothing through: it begins as false, and only the lines that it keeps back make it true."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator

from gz_course.grader.lint.syntax import Place, assignments, functions, last_name

LEAVES = ast.Return | ast.Continue | ast.Raise


def flags_that_never_open(tree: ast.AST) -> Iterator[Place]:
    """Find `if not self.flag: return`, or `if self.flag:`, where nothing else ever sets the flag."""
    made: dict[str, list[ast.Assign]] = {}
    for target, assignment in assignments(tree):
        if isinstance(target, ast.Attribute | ast.Name):
            made.setdefault(ast.unparse(target).removeprefix("self."), []).append(assignment)
    stored = Counter(name for each in ast.walk(tree) if (name := _stored(each)))
    texts = {each.value for each in ast.walk(tree) if isinstance(each, ast.Constant) and isinstance(each.value, str)}
    for function in functions(tree):
        for place, statement in enumerate(function.body):
            if not isinstance(statement, ast.If) or statement.orelse:
                continue
            flag, kept = _kept_back(statement, function.body[place + 1 :])
            name = flag.removeprefix("self.")
            if not flag.startswith("self.") or name in texts or not (sets := made.get(name, [])):
                continue
            if stored[name] != len(sets):
                continue  # it is set in another way, too
            inside = {id(each) for part in kept for each in ast.walk(part)}
            begins = [each for each in sets if id(each) not in inside]
            opens = [each for each in sets if id(each) in inside]
            if opens and begins and all(_is_false(each.value) for each in begins):
                yield (
                    statement.lineno,
                    f"{flag} is {ast.unparse(begins[0].value)} from the beginning, and only line {opens[0].lineno} "
                    f"changes it, which is reached only if {flag} is true: nothing behind this condition ever happens",
                )


def _kept_back(statement: ast.If, behind: list[ast.stmt]) -> tuple[str, list[ast.stmt]]:
    """Return the flag of a condition and the statements that happen only if it is true; an empty name for others."""
    test = statement.test
    if isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not) and isinstance(statement.body[-1], LEAVES):
        return ast.unparse(test.operand), behind
    return (ast.unparse(test), statement.body) if isinstance(test, ast.Attribute) else ("", [])


def _stored(node: ast.AST) -> str:
    """Return the last part of the name that a node gives a value; empty for other nodes."""
    return last_name(node) if isinstance(getattr(node, "ctx", None), ast.Store) else ""


def _is_false(value: ast.expr) -> bool:
    return isinstance(value, ast.Constant) and (value.value is None or value.value is False)


LOOKS = (flags_that_never_open,)
