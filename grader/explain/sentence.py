"""What is said of a search: the places that decide, and what kind of change they need; never the change itself."""

from __future__ import annotations

import ast
import re

from gz_course.grader.edits import Edit
from gz_course.grader.explain.search import Change, Found
from gz_course.grader.feedback.facts.syntax import nodes_of, parsed, unparse

KINDS = {
    "number": "another number",
    "sign": "another sign",
    "arithmetic": "another calculation",
    "logic": "another condition",
    "condition": "another condition",
    "comparison": "another comparison",
    "field": "another field",
    "name": "another name",
    "type": "another type",
    "direction": "another direction",
    "exchanged": "two of its values exchanged",
    "qos": "another QoS",
    "text": "another text",
    "switch": "the other truth value",
    "call": "another function",
    "index": "another index",
    "conversion": "its value in another form",
    "arguments": "its arguments in another order",
    "clock": "another clock",
    "filter": "another choice of rays",
    "forgotten": "less in it",
    "deleted": "this line left out",
    "order": "this line in another place",
    "level": "this line at another level of indentation",
    "command": "one more command beside it",
    "return": "a return after it",
    "goal": "another state of the goal before it",
    "kept": "its object kept alive",
}
OF_THE_LINE = {"name", "type", "qos", "call"}  # not of what the line sets
MOST_NAMED = 40  # [characters] of what a line sets


def sentences(found: Found, files: dict[str, bytes], most: float, *, shown: bool) -> list[str]:
    """Return what to tell a student: one or two sentences. `most` are the points to be had.

    `shown` adds the change itself, where the instructor allows it.
    """
    if not found.changes:
        return _nothing(found, files)
    best = found.changes[0]
    said = [f"{_where(best)}: with {_what(best, files)} your program earns {_points(best, most)} (tried)."]
    for other in found.changes[1:2]:
        if other.outcome.points == best.outcome.points:
            said.append(f"{_where(other, also=True)}, with {_what(other, files)}.")
    if best.outcome.failed:
        missing = best.outcome.failed[0]["title"]
        said.append(f"Then this is still to do: {missing}.")
    if shown:
        said += [f"{each.file}, line {each.line}: {each.was} -> {each.now}" for each in best.edits]
    return said


def _nothing(found: Found, files: dict[str, bytes]) -> list[str]:
    if found.trials == 0:
        return ["Nothing was tried: the budget was spent before the first trial, or the file cannot be read."]
    said = [f"{found.trials} of {found.edits} changes of one place were tried, and none helps by itself."]
    if found.nearest is not None:
        change = found.nearest
        won = _titles(change.outcome.passed - found.before.passed, found)
        lost = _titles(found.before.passed - change.outcome.passed, found)
        said.append(f"{_place(change)} comes nearest: with {_what(change, files)} it passes {won}, but loses {lost}.")
    return said


def _titles(ids: frozenset[str], found: Found) -> str:
    return ", ".join(f'"{each["title"]}"' for each in found.before.checks if each["id"] in ids)


def _points(change: Change, most: float) -> str:
    return f"{change.outcome.points:g} of {most:g}"


def _place(change: Change) -> str:
    lines = list(dict.fromkeys(change.lines))
    several = len({name for name, _ in lines}) > 1
    named = " and ".join(f"{line} of {name}" if several else str(line) for name, line in lines)
    return f"Line{'s' if len(lines) > 1 else ''} {named}"


def _where(change: Change, *, also: bool = False) -> str:
    place = _place(change)
    several = place.startswith("Lines")
    if also:
        return f"So do{'' if several else 'es'} {place[0].lower()}{place[1:]}"
    if change.outcome.failed:
        return f"{place} help{'' if several else 's'}"
    return f"{place} decide{'' if several else 's'} it"


def _what(change: Change, files: dict[str, bytes]) -> str:
    return " and ".join(dict.fromkeys(kind(each, files[each.file]) for each in change.edits))


def kind(edit: Edit, content: bytes) -> str:
    """Return what kind of change an edit is, such as `another number for angular.z`."""
    about, words = _about(edit, content), KINDS[edit.operator]
    named = about and words.startswith("another") and not words.endswith(about) and edit.operator not in OF_THE_LINE
    return f"{words} for {about}" if named else words


def group(found: Found, files: dict[str, bytes]) -> str:
    """Return what the best change is, without names of this program alone, such as `another number for angular.z`."""
    return " and ".join(
        dict.fromkeys(re.sub(r"(?<= for )\w+\.", "", kind(each, files[each.file])) for each in found.changes[0].edits)
    )


def _about(edit: Edit, content: bytes) -> str:
    """Return what the line of an edit sets, such as `angular.z`, or an empty text."""
    if not edit.file.endswith(".py"):
        key = content.split(b"\n")[edit.line - 1].strip().removeprefix(b"- ").partition(b":")
        return key[0].decode(errors="replace") if key[1] and key[0].replace(b"_", b"").isalpha() else ""
    for node in nodes_of(parsed(content), ast.Assign, ast.AugAssign, ast.AnnAssign):
        if node.lineno == edit.line:
            target = node.targets[0] if isinstance(node, ast.Assign) else node.target
            name = unparse(target).removeprefix("self.")
            return name if len(name) <= MOST_NAMED else ""
    return ""
