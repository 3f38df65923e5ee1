"""Mistakes in launch files that raise no error, or one that does not name them.

The kind of submission that is a launch file records them as facts; the diagnosis names them if the run lost points. A
mistake is a function of a `LaunchFile` under `@launch_slip` that yields a line and the words of a sentence.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Mapping
from types import MappingProxyType
from typing import Any

from gz_course.grader.feedback.facts.syntax import Places, places_in
from gz_course.grader.feedback.launch_files.reading import LaunchFile, Place
from gz_course.grader.feedback.rules import Room, findings

MOST = 3  # places reported at most
Rule = Callable[[LaunchFile], Iterator[Place]]
Fact = Callable[[LaunchFile], Iterator[dict[str, Any]]]
ROOM: Room[Rule] = Room(__name__)
FACTS: Room[tuple[str, int | None, Fact]] = Room(__name__)


def launch_slip(function: Rule) -> Rule:
    """Register a mistake in launch files."""
    ROOM.add(function, function)
    return function


def launch_fact(name: str, most: int | None = 2 * MOST) -> Callable[[Fact], Fact]:
    """Register what a file says of the launch, as places of which so many are recorded."""

    def register(function: Fact) -> Fact:
        FACTS.add((name, most, function), function)
        return function

    return register


def launch_places(content: bytes, nodes: Mapping[str, bytes] = MappingProxyType({})) -> dict[str, Places]:
    """Return the places in a launch file, none if it is not Python.

    `launch_slips` are mistakes: `line` and `said`, the words of a sentence. `fixed_worlds` are worlds that a command
    names as a text: `line` and `world`. `declared` are the arguments that the file declares, and the configurations
    with a default that nothing declares: `line`, `name` and `default` (a text, or empty). `remappings` are those of its
    nodes, as `remappings.py` says. `programs` are the Python programs that it starts, as `sim_time.py` says, and
    `simulators_made` and `bridges_made` the actions that start a simulator or a bridge, as `conditions.py` says.
    `fixed_counts` are loops that make so many actions at most, as `counts.py` says.
    `nodes` are the programs that come with the file, by name.
    """
    found: dict[str, Places] = {}

    def look(tree: ast.Module) -> Places:
        file = LaunchFile(tree, content, nodes)
        slips = [place for rule in ROOM.rules() for place in findings(rule, file)]
        first = dict(reversed(slips))  # of several on a line, what is found first
        found["launch_slips"] = [{"line": line, "said": said} for line, said in first.items()][::-1][:MOST]
        found.update({name: findings(fact, file)[:most] for name, most, fact in FACTS.rules()})
        return []

    places_in(content, look)
    return found
