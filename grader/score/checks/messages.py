"""`messages`: did the right messages arrive on a topic: their number, time and text?

kind = "messages"
topic = "hello"
count = [1, 1]            # at least, at most; the second may be left out
window = [0.9, 3.0]       # [s], optional: only messages that arrive then count
field = "data"            # optional, with `says`: only messages whose text field equals it count
says = "hello, robot"

Where `count` has an upper limit and neither time nor text matters, messages that were lost because nobody had found the
publisher yet count too: the node has sent them.
"""

from __future__ import annotations

import numpy as np

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.feedback.predictions.texts import difference, too_many, wrong_moment
from gz_course.grader.feedback.predictions.too_early_or_late import (
    added_up,
    answers_itself,
    counted_late,
    counted_too_far,
    sent_again,
    sent_too_early,
)
from gz_course.grader.printable import shown
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding, check_kind
from gz_course.grader.score.events import texts as texts_of
from gz_course.grader.score.steps import told

LONGEST_QUOTE = 60  # characters of a message's text that are quoted


@check_kind("messages")
def messages(recording: Recording, parameters: Table) -> Finding:
    """Pass if the number of messages that came in the window with the text lies within `count`."""
    topic = parameters.text("topic").strip("/")
    least, *rest = parameters.numbers("count", [1, 2])
    most = rest[0] if rest else np.inf
    window = parameters.numbers("window", [2], [0.0, np.inf]) if parameters.has("window") else None
    says = parameters.text("says") if parameters.has("says") else None
    field = parameters.text("field", "data")
    times = recording.signal(f"topics/{topic}/count").times / 1e9
    texts = [text for _, text in texts_of(recording, topic, field)]
    counts = np.ones(len(times), dtype=bool)
    expected = f"{_number(least, most)} on /{topic}"
    if window is not None:
        counts &= (times >= window[0]) & (times <= window[1])
        expected += f" between {window[0]:g} and {window[1]:g} s"
    if says is not None:
        counts &= np.array([text == says for text in texts], dtype=bool)
        expected += f" saying {says!r}"
    lost = recording.facts().get("too_early", {}).get(f"/{topic}", 0)
    sent = int(counts.sum()) + (lost if window is None and says is None and len(times) else 0)
    passed = bool(least <= counts.sum() and sent <= most)
    if not len(times):
        return Finding(passed, expected, "no message arrived")
    # Report the message that decides: the first one too many, else the first that does not count.
    wrong = np.flatnonzero(counts)[int(most) :] if counts.sum() > most else np.flatnonzero(~counts)
    at = float(times[wrong[0] if len(wrong) and not passed else 0])
    measured = f"1 message arrived, at {told(at)} s" if len(times) == 1 else _many(times)
    if sent > most >= counts.sum():
        was, they = ("was", "it was") if lost == 1 else ("were", "they were")
        measured += f"; {lost} more {was} sent before anybody had found the publisher: {they} lost, but sent"
    if says is not None:
        measured += f"; it said {_quoted(texts[0])}" if len(times) == 1 else f"; the first said {_quoted(texts[0])}"
    why = ""
    if not passed and says is not None:
        why = next((said for text in texts if text is not None and (said := difference(text, says))), "")
    elif not passed and window is not None:
        asked = (window[0], window[1])
        why = counted_late(recording, times, asked) or added_up(recording, times, asked) or wrong_moment(times, asked)
    elif not passed and counts.sum() > most:
        why = (
            counted_too_far(recording, times)
            or sent_again(recording)
            or answers_itself(recording, f"/{topic}", times)
            or too_many(times, recording.ended_s)
        )
    elif not passed and sent > most:
        why = sent_too_early(recording)
    return Finding(passed, expected, measured, round(at, 3), timing=window is not None, explanation=why)


def _number(least: float, most: float) -> str:
    if least == most:
        return "exactly one message" if least == 1 else f"exactly {least:g} messages"
    if np.isinf(most):
        return "at least one message" if least == 1 else f"at least {least:g} messages"
    return f"{least:g} to {most:g} messages"


def _many(times: np.ndarray) -> str:
    return f"{len(times)} messages arrived, the first at {told(times[0])} s, the last at {told(times[-1])} s"


def _quoted(text: str | None) -> str:
    return "something other than a text" if text is None else repr(shown(text, LONGEST_QUOTE))
