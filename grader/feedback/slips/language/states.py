"""States that are set in one spelling and asked for in another, or asked for and never set."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Place, assigned, unparse, walk
from gz_course.grader.feedback.slips import slip
from gz_course.sim.did_you_mean import nearest_name

NEAR = 0.75  # how alike two names of one state are
FEWEST = 3  # letters of a name


@slip
def other_spelling(tree: ast.AST) -> Iterator[Place]:
    """Find `self.state = 'Stop'` where only `self.state == 'stop'` is asked for."""
    given: dict[str, dict[str, int]] = {}
    unknown: set[str] = set()
    for target, value in assigned(tree):
        name = unparse(target)
        if isinstance(value, ast.Constant) and isinstance(value.value, str):
            given.setdefault(name, {}).setdefault(value.value, target.lineno)
        else:
            unknown.add(name)
    elsewhere = {name.rpartition(".")[2] for name in given.keys() | unknown if not name.startswith("self.")}
    asked: dict[str, dict[str, int]] = {}
    equal: set[tuple[str, str]] = set()
    for node in walk(tree):
        match node:
            case ast.Compare(left=left, ops=[ast.Eq() | ast.NotEq()], comparators=[ast.Constant(value=str(text))]):
                asked.setdefault(unparse(left), {}).setdefault(text, node.lineno)
                if isinstance(node.ops[0], ast.Eq):
                    equal.add((unparse(left), text))
    for name in given.keys() & asked.keys() - unknown:
        for text, line in asked[name].items():
            unasked = [each for each in given[name] if each not in asked[name] and len(each) >= FEWEST]
            if text not in given[name] and (near := _alike(text, unasked)):
                yield (
                    line,
                    f"{name} is never {text!r}: line {given[name][near]} sets it to {near!r}, which is spelt otherwise",
                )
            elif text in given[name] or (name, text) not in equal or name.rpartition(".")[2] in elsewhere:
                continue
            elif name.startswith("self.") and given[name].keys() - asked[name].keys():
                values = ", ".join(repr(each) for each in list(given[name])[:4])
                yield line, f"{name} is never {text!r}, so this condition never holds: it is set to {values}"


def _alike(text: str, names: list[str]) -> str:
    same = next((each for each in names if each.casefold() == text.casefold()), "")
    return same or nearest_name(text, names, NEAR) or ""
