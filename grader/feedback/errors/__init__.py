"""What errors mean whose own text does not say what to change; only those with a certain cause.

A meaning is a function of the first line of an error and of the line of the program at the end of its traceback, under
`@explanation`, that returns words, or an empty text for other errors. The errors of launch files, of bridges and of
actions have functions of their own.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable

from gz_course.grader.feedback.rules import Room

Meaning = Callable[[str, str], str]
ROOM: Room[Meaning] = Room(__name__)


def explanation(function: Meaning) -> Meaning:
    """Register what errors mean."""
    ROOM.add(function, function)
    return function


def listed(error: str, meanings: Iterable[tuple[re.Pattern[str], str]]) -> str:
    """Return the words beside the first pattern that an error fits, with its groups filled in; else nothing."""
    found = ((pattern.search(error), words) for pattern, words in meanings)
    return next((words.format(*match.groups()) for match, words in found if match), "")
