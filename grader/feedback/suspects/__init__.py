"""Places that are wrong in most programs that misunderstand angles, headings, gyroscopes, rays, goals or drives.

Each suspect says what it is about. A check that has seen the symptom in the recording names the suspect of that kind
(`grader/feedback/recorded/places.py`); without a symptom nobody hears of it. A suspect is a function of a syntax tree
under `@suspicion` that yields a line, what it is about (`about.py`), and the words of a sentence.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator
from functools import wraps

from gz_course.grader.feedback.facts.syntax import Places, Words, asked_of, places_in
from gz_course.grader.feedback.rules import Room, findings
from gz_course.grader.feedback.suspects.about import About, Suspect

MOST = 20  # suspects kept
Suspicion = Callable[[ast.Module], Iterator[Suspect]]
ROOM: Room[Suspicion] = Room(__name__)


def suspicion(function: Suspicion) -> Suspicion:
    """Register places that are named only with a symptom."""
    ROOM.add(function, function)
    return function


def suspicion_of(
    about: About, *kinds: type[ast.AST], first: bool = False
) -> Callable[[Callable[..., Words]], Suspicion]:
    """Register places that are about one thing, and are named only with a symptom, as `asked_of` says."""

    def register(rule: Callable[..., Words]) -> Suspicion:
        found = asked_of(rule, *kinds, first=first)

        @wraps(rule)
        def find(tree: ast.Module) -> Iterator[Suspect]:
            return ((line, about, words) for line, words in found(tree))

        return suspicion(find)

    return register


def suspects(content: bytes) -> Places:
    """Return `line`, `about` and `said`, the words of a sentence, of each suspect; nothing if it is not Python."""
    return places_in(content, _places)


def _places(tree: ast.Module) -> Places:
    found = dict.fromkeys(place for rule in ROOM.rules() for place in findings(rule, tree))
    return [{"line": line, "about": str(about), "said": said} for line, about, said in list(found)[:MOST]]
