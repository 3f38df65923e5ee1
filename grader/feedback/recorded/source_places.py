"""The lines of a student's file at which to look if all that is known is that a value is wrong, or never sent."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from gz_course.grader.feedback.rules import guarded
from gz_course.grader.printable import shown

LONGEST = 400  # characters of code and line numbers


@guarded("")
def made_in(facts: dict[str, Any]) -> str:
    """Return one sentence about the lines that make what is sent; empty if they are not known, or too many."""
    return _sentence("What your node sends is made in", facts.get("origins", []))


@guarded("")
def stands_before(facts: dict[str, Any], topic: str) -> str:
    """Return one sentence about the conditions before publish() on a topic, of which one never holds, or nothing."""
    return _sentence(
        f"What decides whether publish() on {topic} is reached:",
        [place for place in facts.get("conditions", []) if place["topic"] in ("", topic)],
    )


def _sentence(begin: str, places: Iterable[dict[str, Any]]) -> str:
    said = list(dict.fromkeys(f"line {place['line']}, `{place['code']}`" for place in places))
    return f"{begin} {shown('; '.join(said), LONGEST)}." if said else ""
