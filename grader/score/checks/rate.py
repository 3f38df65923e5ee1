"""`rate`: what is the rate of messages on a topic, in simulated time?

kind = "rate"
topic = "cmd_vel"
hertz = [9.0, 11.0]       # at least, at most; the second may be left out
window = [1.0, 8.0]       # optional
longest_gap = 0.3         # optional: [s] between two messages, the edges of the window included

The rate is the number of messages in the window divided by its length.
"""

from __future__ import annotations

import re

import numpy as np

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.feedback.recorded.places import ended_by_itself, suspect
from gz_course.grader.printable import shown
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding, check_kind
from gz_course.grader.score.steps import told, window_of

FEWEST = 4  # messages; fewer say nothing about a rhythm
MOSTLY = 0.8  # of the gaps


@check_kind("rate")
def rate(recording: Recording, parameters: Table) -> Finding:
    """Pass if the rate lies within `hertz` and no gap is longer than `longest_gap`."""
    topic = parameters.text("topic").strip("/")
    least, *rest = parameters.numbers("hertz", [1, 2])
    most = rest[0] if rest else np.inf
    longest = parameters.number("longest_gap", above=0) if parameters.has("longest_gap") else np.inf
    start, end = window_of(recording, parameters)
    expected = f"at least {least:g}" if np.isinf(most) else f"{least:g} to {most:g}"
    expected += f" messages a simulated second on /{topic}"
    if np.isfinite(longest):
        expected += f", never {longest:g} s without one"
    times = recording.signal(f"topics/{topic}/count").times / 1e9
    times = times[(times >= start) & (times <= end)]
    if not len(times):
        return Finding(False, expected, f"no message arrived between {start:g} and {end:g} s")
    hertz = len(times) / (end - start)
    edges = np.concatenate([[start], times, [end]])
    gaps = np.diff(edges)
    gap, at = float(gaps.max()), float(edges[gaps.argmax()])
    measured = f"{told(hertz)} messages a simulated second; the longest gap was {told(gap)} s, from {told(at)} s on"
    passed = bool(least <= hertz <= most and gap <= longest + 1e-9)
    words = "" if passed or end - times[-1] < gap else ended_by_itself(recording, before=end)
    if not passed and not words:
        words = _why_so_seldom(recording, topic, times, hertz < least, gap if gap > longest else 0.0)
    return Finding(passed, expected, measured, round(at, 3), timing=True, explanation=words)


def _why_so_seldom(recording: Recording, topic: str, times: np.ndarray, few: bool, gap: float) -> str:
    """Return what lets messages come too seldom, if the file and the times between them say so; empty if not.

    `gap` is the longest time without one [s], if it is too long.
    """
    gaps = np.diff(times)
    if few and (words := _every_nth(recording, topic, times)):
        return words
    if len(times) < FEWEST or not (few or gap):
        return ""
    even = float(np.mean(np.abs(gaps - np.median(gaps)) < 0.1 * np.median(gaps)))
    if gap > 2 * np.median(gaps):
        even = 0.0
    rhythm = [each for each in recording.facts().get("rhythm", []) if each["topic"] == f"/{topic}"]
    for each in rhythm if few else ():
        if even >= MOSTLY and abs(each.get("period", 0) / np.median(gaps) - 1) < 0.1:
            return shown(f"line {each['line']}: {each['said']}", 300)
    if even >= MOSTLY:
        return ""
    words = next((f"line {each['line']}: {each['said']}" for each in rhythm if "period" not in each), "")
    if words:
        return shown(f"{words}, so no message comes in between: publish in each call of a timer of its own", 400)
    return suspect(recording, "sleep")


def _every_nth(recording: Recording, topic: str, times: np.ndarray) -> str:
    """Return that messages come only with every n-th one of another topic, if the file counts so; empty if not."""
    said = suspect(recording, "every")
    counted = re.search(r"one in (\d+) calls", said)
    if not counted or len(times) < FEWEST:
        return ""
    number, gap = int(counted[1]), float(np.median(np.diff(times)))
    for name in recording.signals():
        if not name.startswith("topics/") or name.startswith(f"topics/{topic}/"):
            continue
        others = recording.signal(name).times / 1e9
        between = np.diff(np.searchsorted(others, times + 1e-6))
        if np.mean(np.abs(between - number) < 0.5) >= MOSTLY:
            return f"{said}, so a message comes only every {told(gap)} s"
    return ""
