"""The order in which edits are tried: what the report says of the run, and where in the file that comes from."""

from __future__ import annotations

import ast
import math
import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence

from gz_course.grader.edits import Edit
from gz_course.grader.explain.task import words_in
from gz_course.grader.feedback.facts.syntax import parsed, unparse, walk

LINE = re.compile(r"(?P<file>[\w./-]+\.\w+)(?:, line |:)(?P<one>\d+)|line (?P<bare>\d+)")
# How often an edit of its type is what a student needs; the others 0.
PRIOR = {
    "number": 1.0,
    "sign": 1.0,
    "arithmetic": 0.6,
    "field": 1.0,
    "name": 1.2,
    "type": 0.8,
    "direction": 1.2,
    "qos": 0.8,
    "comparison": 0.8,
    "command": 0.9,
    "filter": 1.2,
    "switch": 0.8,
    "clock": 1.0,
    "kept": 0.6,
    "goal": 0.5,
    "condition": 0.3,
    "index": 0.5,
    "conversion": 0.3,
    "text": -0.5,
    "order": -0.3,
    "deleted": -0.4,
    "forgotten": -0.6,
}
NAMED, FLOWS, SHARED, NEXT = (
    3.0,
    0.7,
    1.6,
    0.45,
)  # for a line that the report names, ...
RIGHT, STOP = 0.8, 1.2  # for a line of what is right; for one more command if something does not stop
PUBLISHED = re.compile(r"\.(publish|publish_feedback|send_goal_async|call_async|sendTransform|succeed)\(")


def ordered(edits: Sequence[Edit], files: dict[str, bytes], said: str, words: set[str], right: set[str]) -> list[Edit]:
    """Return edits of files, the likeliest to mend first.

    `said` is what the report says of the whole run, `words` those of its failed checks, `right` those of the others.
    """
    named = named_lines(said, files)
    weights = {name: _weights(name, files[name], words - right, right - words) for name in {e.file for e in edits}}
    more = {"command": STOP if words & {"stop", "stops", "stand", "stands"} else 0.0}
    tried: dict[tuple[str, int, str, str], int] = defaultdict(int)
    scored = list[tuple[float, str, int, int, Edit]]()
    for edit in edits:
        weight = PRIOR.get(edit.operator, 0.0) + more.get(edit.operator, 0.0) + weights[edit.file].get(edit.line, 0.0)
        weight += NAMED * ((edit.file, edit.line) in named or ("", edit.line) in named)
        place = (edit.file, edit.begin, edit.was, edit.operator)
        weight -= NEXT * tried[place]
        tried[place] += 1
        scored.append((-weight, edit.file, edit.line, len(scored), edit))
    return [each[-1] for each in sorted(scored, key=lambda each: each[:4])]


def named_lines(said: str, files: dict[str, bytes]) -> set[tuple[str, int]]:
    """Return the files and lines that a report names; an entry of a YAML file is named by its first line."""
    found = {(each["file"] or "", int(each["one"] or each["bare"])) for each in LINE.finditer(said)}
    for name, content in files.items():
        if not name.endswith((".yaml", ".yml")):
            continue
        lines = content.decode(errors="replace").split("\n")
        for _, first in [each for each in found if each[0] in ("", name)]:
            for number in range(first + 1, len(lines) + 1):
                if lines[number - 1].lstrip().startswith("- "):
                    break
                found.add((name, number))
    return found


def _weights(name: str, content: bytes, words: set[str], right: set[str]) -> dict[int, float]:
    """Return how much each line of a file has to do with what failed, and not with what is `right`."""
    lines = content.decode(errors="replace").split("\n")
    own = [words_in(line) for line in lines]
    common = Counter(word for each in own for word in each)
    weights: dict[int, float] = {}
    for number, found in enumerate(own, 1):
        shared = sorted((1 / math.sqrt(common[word]) for word in found & words), reverse=True)[:3]
        weights[number] = SHARED * min(1.0, sum(shared) / 1.5) - RIGHT * bool(found & right and not found & words)
    if name.endswith(".py"):
        for number in _flowing(content):
            weights[number] = weights.get(number, 0.0) + FLOWS
    return weights


def _flowing(content: bytes) -> set[int]:
    """Return the lines of a Python file whose values reach what it publishes, by names alone."""
    statements = [each for each in walk(parsed(content)) if isinstance(each, ast.stmt) and not hasattr(each, "body")]
    reaching, lines = set[str](), set[int]()
    for statement in statements:
        if PUBLISHED.search(unparse(statement)):
            lines.update(_lines(statement))
            reaching |= set(_read(statement))
    for _ in range(8):  # as many steps backwards as matter
        before = len(reaching)
        for statement in statements:
            targets = getattr(statement, "targets", None) or [getattr(statement, "target", None)]
            if any(isinstance(each, ast.expr) and set(_read(each)) & reaching for each in targets):
                lines.update(_lines(statement))
                reaching |= set(_read(statement))
        if len(reaching) == before:
            break
    return lines


def _lines(statement: ast.stmt) -> Iterable[int]:
    return range(statement.lineno, (statement.end_lineno or statement.lineno) + 1)


def _read(node: ast.AST) -> Iterable[str]:
    """Yield the names in an expression, those of `self` with their attribute."""
    for each in ast.walk(node):
        if isinstance(each, ast.Name) and each.id != "self":
            yield each.id
        elif isinstance(each, ast.Attribute) and isinstance(each.value, ast.Name) and each.value.id == "self":
            yield f"self.{each.attr}"
