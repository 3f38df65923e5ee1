r"""`text`: does the node write a text, in its log or in a message?

kind = "text"
log = '^arrived at \S+'   # a pattern for lines of the node's logger; or
topic = "state"           # for messages on this topic:
field = "data"            #   the text field, and
says = '^done$'           #   a pattern for it
count = [1]               # at least, at most; at least one if left out. [0, 0] forbids the text (add a gate)
window = [0.0, 8.0]       # optional
"""

from __future__ import annotations

import re

import numpy as np

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.printable import shown
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding, check_kind
from gz_course.grader.score.events import log_lines, not_logged, texts
from gz_course.grader.score.steps import how_many, told, window_of

LONGEST_QUOTE = 80  # characters of a text that are quoted


@check_kind("text")
def text(recording: Recording, parameters: Table) -> Finding:
    """Pass if the number of matching lines or messages in the window lies within `count`."""
    if parameters.has("log") == parameters.has("topic"):
        parameters.refuse("log", "given, or topic instead of it, but not both")
    pattern: re.Pattern[str]
    printed = ""
    if parameters.has("log"):
        pattern, where = parameters.regex("log"), "lines in the node's log"
        said = [(at, line) for at, line, logged in log_lines(recording) if logged]
        printed = not_logged(recording, pattern)
    else:
        topic, field = parameters.text("topic").strip("/"), parameters.text("field", "data")
        pattern, where = parameters.regex("says"), f"messages on /{topic}"
        said = [(at, line) for at, line in texts(recording, topic, field) if line is not None]
    least, *rest = parameters.numbers("count", [1, 2], [1.0])
    most = rest[0] if rest else np.inf
    start, end = window_of(recording, parameters)
    matching = [(at, line) for at, line in said if pattern.search(line)]
    due = [(at, line) for at, line in matching if start <= at <= end]
    expected = f"{how_many(least, most)} {where} like {pattern.pattern!r}"
    passed = bool(least <= len(due) <= most)
    measured = f"{len(due)} of {len(said)}"
    if due:
        measured += f", the first at {told(due[0][0])} s: {shown(due[0][1], LONGEST_QUOTE)!r}"
    elif matching:
        measured += f"; one at {told(matching[0][0])} s, not between {start:g} and {end:g} s"
    elif printed:
        measured += f"; {printed}"
    elif said:
        measured += f"; the last was {shown(said[-1][1], LONGEST_QUOTE)!r}"
    moments = [at for at, _ in due or matching]
    moment = round(moments[0], 3) if moments else None
    return Finding(passed, expected, measured, moment, timing=bool(matching) and not due)
