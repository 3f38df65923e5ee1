r"""`per_scan`: is every scan answered with the right number?

    kind = "per_scan"
    scan = "lidar/scan"
    statistic = "minimum"     # valid_count | minimum | mean of the valid ranges
    tolerance = 0.011
    log = 'min=(\S+?)m'       # the answer is the first group of this pattern in a line of the node's logger,
    line = "min=1.23m"        # of which this is an example (optional), or
    signal = "topics/nearest_obstacle/data"    # the answer is a message
    at_least = 0.95           # of all scans

The answers to a scan are those between it and the next scan; every one of them must be right. They are compared with
the scan that was sent. A range
is valid if it lies between range_min and range_max; answers that include or exclude the limits are both accepted.
Wrong answers are compared with those of common misconceptions (`explanations/of_answers/`).
"""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.feedback.predictions.answers import Asked, Explanation, Scans, explain
from gz_course.grader.feedback.predictions.texts import line_difference
from gz_course.grader.printable import shown
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding, check_kind
from gz_course.grader.score.events import log_lines, not_logged

LONGEST_LINE = 120  # [characters] of a line that is quoted
LINES = 6  # without an answer, that are compared with the line that is asked for

STATISTICS: dict[str, Callable[[np.ndarray], float]] = {
    "valid_count": lambda valid: float(len(valid)),
    "minimum": lambda valid: float(valid.min()),
    "mean": lambda valid: float(valid.mean()),
}


@dataclass(frozen=True)
class Scan:
    """One scan as it was sent: its number, its time [s], the time of the next [s], and the accepted answers.

    `row` are its ranges [m], `low` and `high` their bounds [m].
    """

    number: int
    start: float
    end: float
    answers: tuple[float, ...]
    row: np.ndarray
    low: float
    high: float


def scans(recording: Recording, topic: str, statistic: str) -> list[Scan]:
    """Return every scan that had at least one valid ray."""
    times, rows = recording.arrays(f"topics/{topic}/ranges")
    lows = recording.signal(f"topics/{topic}/range_min").values
    highs = recording.signal(f"topics/{topic}/range_max").values
    ends = [*(times[1:] / 1e9), np.inf] if len(times) else []
    found = []
    for number, (time, end, row, low, high) in enumerate(zip(times / 1e9, ends, rows, lows, highs, strict=True)):
        # A message holds 0.12 as the nearest float32, so the student's node receives that value.
        low, high, row = np.float32(low), np.float32(high), row.astype(np.float32).astype(np.float64)
        strict = row[(row > low) & (row < high)]
        loose = row[(row >= low) & (row <= high)]
        if len(strict):
            answers = tuple(STATISTICS[statistic](valid) for valid in (strict, loose))
            found.append(Scan(number, float(time), float(end), answers, row, float(low), float(high)))
    return found


@check_kind("per_scan")
def per_scan(recording: Recording, parameters: Table) -> Finding:
    """Pass if at least the fraction `at_least` of all scans got the right answer."""
    what = parameters.choice("statistic", STATISTICS)
    tolerance, share = parameters.number("tolerance"), parameters.number("at_least", 0.95)
    topic = parameters.text("scan")
    asked = scans(recording, topic, what)
    others: list[str] = []
    printed, odd, example = "", "", ""
    if parameters.has("signal"):
        signal = parameters.text("signal")
        given = _messages(recording, signal)
        not_finite = len(recording.signal(f"{signal}/not_finite"))
        where = f"on {signal}"
    else:
        given, others, odd = _log_answers(recording, parameters.pattern("log"))
        example = parameters.text("line") if parameters.has("line") else ""
        printed = not_logged(recording, parameters.pattern("log"))
        not_finite = 0
        where = "in the node's log"
    other = others[0] if others else ""
    expected = f"{what.replace('_', ' ')} of every scan {where}, within {tolerance:g}"
    right, unanswered, wrong = 0, 0, ""
    times = [time for time, _ in given]
    at: float | None = None
    for scan in asked:
        answers = [value for _, value in given[bisect_left(times, scan.start) : bisect_left(times, scan.end)]]
        off = [v for v in answers if not any(abs(v - truth) <= tolerance for truth in scan.answers)]
        if answers and not off:
            right += 1
            continue
        answer = off[0] if answers else None
        unanswered += answer is None
        if answer is not None and not wrong:
            which = f" (one of {len(answers)} answers to that scan)" if len(answers) > 1 else ""
            wrong = f"; at {scan.start:.2f} s it said {answer:g}{which}, the truth was {round(scan.answers[0], 3):g}"
        if at is None:
            at = round(scan.start, 3)
    if printed and not given:
        wrong = f"; {printed}"
    elif parameters.has("log") and not given and not other:
        wrong = "; nothing was logged: self.get_logger().info(...) logs a line, .debug(...) stays silent"
    elif other and not given:
        wrong = f"; no line of the log has the form that is asked for; one was {shown(other, LONGEST_LINE)!r}"
    if not_finite:
        wrong += f"; {not_finite} answers were inf, -inf or nan"
    measured = f"{right} of {len(asked)} scans right" + (f", {unanswered} without an answer" if unanswered else "")
    passed = bool(asked) and right >= share * len(asked)
    if passed or not asked:
        return Finding(passed, expected, measured + wrong, None if passed else at)
    infinite = recording.signal(f"{signal}/not_finite").times / 1e9 if parameters.has("signal") else np.empty(0)
    why = explain(_asked(recording, topic, what, tolerance, asked, given + [(float(t), np.nan) for t in infinite]))
    if odd:
        comma = ", a decimal comma" if re.fullmatch(r"-?\d+,\d+", odd) else ""
        why = Explanation(f"{shown(odd, 40)!r} in the log is no number{comma}: a number has digits and a decimal point")
    if printed and not given:
        why = Explanation(printed)
    if parameters.has("log") and not given and not printed and (lines := recording.facts().get("silent_log")):
        why = Explanation(f"line {lines[0]['line']}: {lines[0]['said']}")
    if parameters.has("log") and given and unanswered and (lines := recording.facts().get("seldom_log")):
        why = Explanation(f"line {lines[0]['line']}: {lines[0]['said']}: {unanswered} scans have no line")
    if others and not given and example and (differs := line_difference(others, example)):
        why = Explanation(shown(differs, 300).replace("{}", ""))
    return Finding(False, expected, measured + wrong, at, explanation=str(why), answers=why)


def _asked(
    recording: Recording, topic: str, what: str, tolerance: float, asked: list[Scan], given: list[tuple[float, float]]
) -> Asked:
    """Return questions and answers as the explanations see them; NaN stands for an answer that is not finite."""
    given = sorted(given, key=lambda answer: answer[0])
    times = np.array([time for time, _ in given])
    first = np.searchsorted(times, [scan.start for scan in asked])
    answered = np.array([i < len(given) and given[i][0] < scan.end for i, scan in zip(first, asked, strict=True)])
    values = np.array([given[i][1] if there else np.nan for i, there in zip(first, answered, strict=True)])
    after = np.searchsorted(times, [scan.end for scan in asked])
    last = np.array([given[i - 1][1] if there else np.nan for i, there in zip(after, answered, strict=True)])
    parts = [[value for _, value in given[i:j]] for i, j in zip(first, after, strict=True)]
    spread = np.array([max(part) - min(part) if part else 0.0 for part in parts])

    def limit(name: str, otherwise: float) -> np.ndarray:
        values = recording.signal(f"topics/{topic}/{name}").values
        return np.array([values[scan.number] if scan.number < len(values) else otherwise for scan in asked])

    return Asked(
        what,
        np.array([scan.start for scan in asked]),
        np.array([scan.answers[0] for scan in asked]),
        values,
        answered,
        tolerance,
        STATISTICS[what],
        Scans(
            [scan.row for scan in asked],
            np.array([scan.low for scan in asked]),
            np.array([scan.high for scan in asked]),
            limit("angle_min", -np.pi),
            limit("angle_max", np.pi),
        ),
        last,
        after - first,
        spread,
    )


def _messages(recording: Recording, name: str) -> list[tuple[float, float]]:
    """Return all answers given as messages: (time [s], value), in order."""
    signal = recording.signal(name)
    return list(zip((signal.times / 1e9).tolist(), signal.values.tolist(), strict=True))


def _log_answers(recording: Recording, pattern: re.Pattern[str]) -> tuple[list[tuple[float, float]], list[str], str]:
    """Return all answers in the log, the first lines without an answer, and the first answer that is no number."""
    answers: list[tuple[float, float]] = []
    others: list[str] = []
    odd = ""
    for at, text, logged in log_lines(recording):
        if not logged:
            continue
        if match := pattern.search(text):
            answers.append((at, _number(match.group(1))))
            odd = odd or (match.group(1) if np.isnan(answers[-1][1]) and match.group(1).lower() != "nan" else "")
        elif len(others) < LINES:
            others.append(text)
    return answers, others, odd


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return np.nan
