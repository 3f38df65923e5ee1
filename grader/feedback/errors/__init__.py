"""What errors mean whose own text does not say what to change; only those with a certain cause.

A meaning is a function of the first line of an error and of the line of the program at the end of its traceback, under
`@explanation`, that returns words, or an empty text for other errors. The errors of launch files, of bridges and of
actions have functions of their own.
"""

from __future__ import annotations

import re
from collections.abc import Callable

from gz_course.grader.feedback.rules import Room

Meaning = Callable[[str, str], str]
ROOM: Room[Meaning] = Room(__name__)


def explanation(function: Meaning) -> Meaning:
    """Register what errors mean."""
    ROOM.add(function, function)
    return function


Table = tuple[tuple[re.Pattern[str], str], ...]


def table(text: str) -> Table:
    """Return the patterns of a text, each with the words below it.

    What begins at the margin is a pattern, what is indented below it the words; either may take several lines. In the
    words, {0} and {1} are the groups of the pattern.
    """
    rows: list[tuple[str, str]] = []
    for line in text.splitlines():
        if line.startswith(" "):
            pattern, words = rows[-1]
            rows[-1] = pattern, f"{words} {line.strip()}".lstrip()
        elif line and not line.startswith("#"):
            above = rows.pop()[0] if rows and not rows[-1][1] else ""
            rows.append((above + line, ""))
    return tuple((re.compile(pattern), words) for pattern, words in rows)


def listed(error: str, meanings: Table) -> str:
    """Return the words beside the first pattern that an error fits, with its groups filled in; else nothing."""
    found = ((pattern.search(error), words) for pattern, words in meanings)
    return next((words.format(*match.groups()) for match, words in found if match), "")
