"""Mistakes of a first month with Python and rclpy that raise no error, or one that does not name them.

A kind of submission that is Python records these places as facts of a run. The diagnosis names them only if the run
lost points. A slip is a function of a syntax tree under `@slip` that yields a line and the words of a sentence.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from gz_course.grader.feedback.facts.syntax import Place, Places, Words, asked_of, places_in
from gz_course.grader.feedback.rules import Room, findings

MOST = 3  # places reported at most
LONGEST_PERIOD = 60.0  # [s] a longer period of a timer was hardly meant


@dataclass(frozen=True)
class Run:
    """What is known of a run before it: its length [s], the fields of its messages by class, its trials' parameters."""

    duration: float = LONGEST_PERIOD
    fields: Mapping[str, list[str]] = field(default_factory=dict)
    names: Sequence[str] = ()


Slip = Callable[[ast.Module], Iterator[Place]]
SlipOfRun = Callable[[ast.Module, Run], Iterator[Place]]
ROOM: Room[Slip] = Room(__name__)
OF_RUNS: Room[SlipOfRun] = Room(__name__)


def slip(function: Slip) -> Slip:
    """Register a mistake that is certain by the text of a file."""
    ROOM.add(function, function)
    return function


def slip_of(*kinds: type[ast.AST], first: bool = False) -> Callable[[Callable[..., Words]], Slip]:
    """Register a mistake that is looked for in nodes of these classes, as `asked_of` says."""
    return lambda rule: slip(asked_of(rule, *kinds, first=first))


def slip_of_run(function: SlipOfRun) -> SlipOfRun:
    """Register a mistake that is certain by the text of a file and its run; it is said before the others."""
    OF_RUNS.add(function, function)
    return function


def slips(
    content: bytes,
    duration: float = LONGEST_PERIOD,
    fields: Mapping[str, list[str]] | None = None,
    names: Sequence[str] = (),
) -> Places:
    """Return `line` and `said`, the words of a sentence, of each such place; nothing if the file is not Python.

    `duration` [s] is the length of the run, `fields` are those of the messages of the exercise, by class;
    `names` those of the parameters that its trials give the node.
    """
    run = Run(duration, fields or {}, names)
    return places_in(content, lambda tree: _places(tree, run))


def _places(tree: ast.Module, run: Run) -> Places:
    found = [place for rule in OF_RUNS.rules() for place in findings(rule, tree, run)]
    found += [place for rule in ROOM.rules() for place in findings(rule, tree)]
    return [{"line": line, "said": said} for line, said in found[:MOST]]
