"""The places of a student's file that were recorded as facts of its run, as sentences for what a check has seen."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from gz_course.grader.feedback.rules import guarded
from gz_course.grader.printable import shown
from gz_course.grader.record.reading import Recording

LONGEST = 400  # characters of code and line numbers


@guarded("")
def ended_by_itself(recording: Recording, before: float | None = None) -> str:
    """Return when a node ended by itself, without an error, and where; empty if it ran on.

    `before` [s] is when what has to be explained happened.
    """
    facts = recording.facts()
    at = facts.get("exit_at")
    if at is None or facts.get("exit_code") not in (None, 0) or (before is not None and at > before):
        return ""
    place = next(iter(facts.get("own_ends", [])), None)
    where = f": line {place['line']}: {place['said']}" if place else ", and nothing of it runs after that"
    return shown(f"the node's process ended by itself at {at:.1f} s (exit code 0){where}", 400)


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


@guarded("")
def suspect(recording: Recording, *about: str) -> str:
    """Return words on the first suspect about one of these things, with its line; empty if there is none.

    The nodes of a launch are several files, so the name of the file stands before the line.
    """
    facts = recording.facts()
    found = [each for each in facts.get("suspects", []) if each["about"] in about]
    if not found:
        return ""
    where = f"{found[0]['file']}, line" if "launch" in facts and "file" in found[0] else "line"
    return shown(f"{where} {found[0]['line']}: {found[0]['said']}", 400)
