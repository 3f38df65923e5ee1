"""Explanations of a text that is nearly right, of a message at the wrong moment, and of too many messages."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Sequence
from itertools import combinations

import numpy as np

from gz_course.grader.feedback.rules import guarded
from gz_course.sim.did_you_mean import nearest_name

# What makes a text equal to the wanted one if it is taken away -> its name.
IGNORED: dict[str, Callable[[str], str]] = {
    "capitals and small letters": str.lower,
    "spaces": lambda text: re.sub(r"\s", "", text),
    "quotation marks": lambda text: re.sub(r"['\"`\u2018\u2019\u201c\u201d]", "", text),
    "punctuation marks": lambda text: re.sub(r"[.,;:!?\u2026-]", "", text),
}


@guarded("")
def difference(said: str, wanted: str) -> str:
    """Return in what a text differs from the wanted one; empty if it does not, or in more than can be named."""
    if said == wanted:
        return ""
    if not said:
        return "the text is empty: nothing was put into it before publish()"
    if said.strip() == wanted:
        return "the text has white space before or after it"
    if said.startswith(("std_msgs", "b'", "{'data", "data:")) or "String(data=" in said:
        return "the text is that of a whole message or of bytes: only its words belong in data"
    plain = unicodedata.normalize("NFKC", said)
    for number in range(1, len(IGNORED) + 1):
        for names in combinations(IGNORED, number):
            one, other = plain, wanted
            for name in names:
                one, other = IGNORED[name](one), IGNORED[name](other)
            if one == other:
                coded = said[:1] == said[-1:] == '"' or said[:1] == said[-1:] == "'"
                why = ", as json.dumps() and repr() put them round it" if coded else ""
                return f"the text differs in {' and '.join(names)} only{why}"
    if nearest_name(said, [wanted], 0.8):
        return "the text is nearly right: compare it letter by letter"
    if wanted in said:
        return "the text holds more than is asked for"
    return ""


def asked_for(window: tuple[float, float]) -> float:
    """Return the time [s] that a task asks for, given the window around it."""
    start, end = window
    return 1.0 if start <= 1.0 <= end else (start + end) / 2


@guarded("")
def wrong_moment(times: np.ndarray, window: tuple[float, float]) -> str:
    """Return why messages missed their window; empty if the time tells nothing."""
    if not len(times):
        return ""
    first, (start, end) = float(times[0]), window
    if start <= first <= end:
        return ""
    middle = asked_for(window)
    for factor, words in ((2, "twice"), (3, "three times"), (0.5, "half"), (0.1, "a tenth of"), (10, "ten times")):
        if abs(first - factor * middle) <= 0.06 * factor * middle:
            return f"the message came after {first:.2f} s, {words} the {middle:g} s that are asked for"
    if first < start:
        return f"the message came at {first:.2f} s, {start - first:.2f} s too soon"
    return f"the message came at {first:.2f} s, {first - end:.2f} s too late"


@guarded("")
def too_many(times: np.ndarray, ended: float) -> str:
    """Return how messages that are too many follow each other, given their times and the end of the run [s]."""
    if len(times) < 2:
        return ""
    gaps = np.diff(times)
    if (together := int(np.sum(times - times[0] < 1e-3))) > 1:
        return f"publish() was called {together} times at the same moment"
    if np.ptp(gaps) > 0.05 * gaps[0]:
        return ""
    if times[-1] + gaps[0] > ended:
        return f"a message came every {gaps[0]:.2f} s until the end: the callback that publishes goes on being called"
    return f"the messages came {gaps[0]:.2f} s apart and ceased: two timers, or a count, send them"


NUMBER = r"[-+]?\d+\.?\d*(?:e[-+]?\d+)?|(?<![a-zA-Z])[-+]?(?:inf|nan)(?![a-ln-zA-Z])"
WHOLE, FRACTION = "N", "N.NN"  # what stands for numbers when two lines are compared
TOKEN = rf"{re.escape(FRACTION)}|{WHOLE}(?![a-zA-Z]{{2}})|[a-zA-Z]+|[^\w\s]|\s+|\w"


def _form(line: str) -> list[str]:
    """Return the words and marks of a line with all its numbers replaced."""
    form = re.sub(NUMBER, lambda match: WHOLE if match[0].isdecimal() else FRACTION, line)
    return re.findall(TOKEN, form)


@guarded("")
def line_difference(lines: Sequence[str], wanted: str) -> str:
    """Return in what the first line of a log differs from an example of the wanted line, whatever numbers they hold.

    Where one line is wanted and its parts stand in several, that is said.
    """
    if not lines:
        return ""
    forms, asked = [_form(line) for line in lines], _form(wanted)
    words = {token for token in asked if token.isalpha() and len(token) > 2}
    if not words <= set(forms[0]) and words <= {token for form in forms for token in form}:
        return f"the line is spread over several: one call of info() logs all of it, as in {wanted!r}"
    form = forms[0]
    start = next((i for i, (a, b) in enumerate(zip(form, asked, strict=False)) if a != b), min(len(form), len(asked)))
    if form == asked:
        return ""
    where = f"after {''.join(form[max(0, start - 4) : start]).strip()!r}" if start else "at its beginning"
    has = f"has {_shortly(form[start:])!r}" if start < len(form) else "ends"
    if start == len(asked):
        return f"{where} the line {has}, where it should end (N and N.NN stand for numbers)"
    return f"{where} the line {has}, where {_shortly(asked[start:])!r} is asked for (N and N.NN stand for numbers)"


def _shortly(tokens: Sequence[str]) -> str:
    return "".join(tokens[:4]).rstrip()
