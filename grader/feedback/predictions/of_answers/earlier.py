"""Answers that mix in, or repeat, what belongs to earlier questions."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np

from gz_course.grader.feedback.predictions.answers import LAST, NEARLY_ALL, Asked, Named, predict, predicts


def _before(truth: np.ndarray, count: int) -> np.ndarray:
    return np.concatenate([np.full(min(count, len(truth)), np.nan), truth[:-count]])


@predicts("those of the scan before")
def scan_before(asked: Asked) -> np.ndarray:
    return _before(asked.truth, 1)


@predicts("those of two scans before")
def two_before(asked: Asked) -> np.ndarray:
    return _before(asked.truth, 2)


@predicts("those of three to ten scans before: they come late", rank=2)
def long_before(asked: Asked) -> np.ndarray:
    shifted = [_before(asked.truth, count) for count in range(3, 11)]
    return max(shifted, key=asked.met)


predict(
    "the smallest of all scans so far, not of this scan: begin again in every callback",
    lambda asked: np.minimum.accumulate(asked.truth),
)
predict(
    "the smallest of all scans before this one: this scan is not among them",
    lambda asked: _before(np.minimum.accumulate(asked.truth), 1),
)
predict(
    "the largest of all scans so far, not of this scan: begin again in every callback",
    lambda asked: np.maximum.accumulate(asked.truth),
)
predict(
    "the average of all scans so far, not of this scan alone",
    lambda asked: np.cumsum(asked.truth) / np.arange(1, len(asked.truth) + 1),
)


@predicts("the average of all valid ranges so far, not of those of this scan alone", only=("mean",))
def average_of_all_ranges(asked: Asked) -> np.ndarray:
    if asked.scans is None:
        return asked.unknown
    valid = asked.scans.valid
    return np.cumsum([v.sum() for v in valid]) / np.cumsum([len(v) for v in valid])


predict("the sum over all scans so far: begin again in every callback", lambda asked: np.cumsum(asked.truth))


@predicts("the average of this scan and the one before")
def smoothed_over_two(asked: Asked) -> np.ndarray:
    return (asked.truth + _before(asked.truth, 1)) / 2


@predicts("a moving average", rank=2)
def moving_average(asked: Asked) -> Named:
    words = "a moving average over the last {} scans, not the value of this scan"
    return _widest_fit(asked, words, np.mean, (*range(3, 11), 12, 15, 20, 25, 30, 50))


@predicts("the smallest of a few scans", rank=2)
def smallest_of_a_few(asked: Asked) -> Named:
    return _widest_fit(asked, "the smallest of the last {} scans, not of this scan", np.min, range(2, 11))


@predicts("the largest of a few scans", rank=2)
def largest_of_a_few(asked: Asked) -> Named:
    return _widest_fit(asked, "the largest of the last {} scans, not the value of this scan", np.max, range(2, 11))


@predicts("a moving median", rank=2)
def moving_median(asked: Asked) -> Named:
    return _widest_fit(asked, "a median over the last {} scans, not the value of this scan", np.median, (3, 5, 7, 9))


@predicts("a low-pass filter of the values (a part of the last answer is kept), not the value of this scan", rank=2)
def low_pass(asked: Asked) -> np.ndarray:
    filtered = []
    for keep in (0.5, 0.7, 0.75, 0.8, 0.9, 0.95, 0.3, 0.25, 0.2, 0.1):
        values = asked.truth.copy()
        for i in range(1, len(values)):
            values[i] = keep * values[i - 1] + (1 - keep) * asked.truth[i]
        filtered.append(values)
    return max(filtered, key=asked.met)


predict(
    "the change since the scan before, not the value of this scan", lambda asked: asked.truth - _before(asked.truth, 1)
)


@predicts("the answer before once more, not a new one", rank=LAST)
def same_again(asked: Asked) -> np.ndarray:
    """Return the answers before, if they are repeated where the right value has changed."""
    known = np.flatnonzero(asked.answered)
    known = known[known > 0]
    repeated = asked.given[known] == asked.given[known - 1]
    changed = np.abs(asked.truth[known] - asked.truth[known - 1]) > asked.tolerance
    if changed.sum() < 2 or not np.ptp(asked.given[asked.answered]) > 0 or repeated[changed].mean() < NEARLY_ALL:
        return asked.unknown
    return _before(asked.given, 1)


PAST: tuple[tuple[str, Callable[[np.ndarray], np.ndarray]], ...] = (
    ("the {} of the scan before", lambda values: _before(values, 1)),
    ("the average, over all scans so far, of the {}", lambda values: np.cumsum(values) / np.arange(1, len(values) + 1)),
    ("the smallest, over all scans so far, of the {}", np.minimum.accumulate),
    ("the largest, over all scans so far, of the {}", np.maximum.accumulate),
    ("the sum, over all scans so far, of the {}", np.cumsum),
)
OTHER: tuple[tuple[str, str, Callable[[np.ndarray], float]], ...] = (
    ("minimum", "smallest valid range", np.min),
    ("mean", "average of the valid ranges", np.mean),
    ("valid_count", "number of valid rays", len),
    ("", "largest valid range", np.max),
)


@predicts("another statistic, of other scans", rank=LAST)
def other_statistic_of_the_past(asked: Asked) -> Named:
    """Return what another statistic, taken over earlier scans, too, gives."""
    candidates = [
        Named(words.format(name), past(asked.of_valid(of)))
        for statistic, name, of in OTHER
        if statistic != asked.statistic
        for words, past in PAST
    ]
    return max(candidates, key=lambda each: asked.met(each.answers))


predict("the time [s] of the scan", lambda asked: asked.times)


@predicts("always that of the first scan")
def first_scan(asked: Asked) -> np.ndarray:
    moved = np.ptp(asked.truth) > 3 * asked.tolerance if len(asked.truth) else False
    return np.full(len(asked.truth), asked.truth[0] if moved else np.nan)


@predicts("always the same number, whatever the scan", rank=LAST)
def constant(asked: Asked) -> np.ndarray:
    values = asked.given[asked.answered & np.isfinite(asked.given)]
    if not len(values):
        return asked.unknown
    same = np.ptp(values) == 0 and np.ptp(asked.truth) > 3 * asked.tolerance and values[0] != 0
    known = asked.scans is not None and values[0] in (asked.scans.low[0], asked.scans.high[0], len(asked.scans.rows[0]))
    first = abs(values[0] - asked.truth[0]) <= asked.tolerance
    return np.full(len(asked.truth), values[0] if same and not known and not first else np.nan)


predict("0 in every scan", lambda asked: np.zeros(len(asked.truth)), rank=0)


@predicts("numbers that count up by one: a counter of the scans", rank=2)
def counter(asked: Asked) -> np.ndarray:
    values = asked.given
    known = np.flatnonzero(asked.answered & np.isfinite(values))
    start = values[known[0]] - known[0] if len(known) else np.nan
    return np.arange(len(asked.truth)) + start


def _widest_fit(asked: Asked, words: str, value: Callable[[np.ndarray], float], widths: Iterable[int]) -> Named:
    """Return the values over as many of the last scans as fit the answers best."""
    candidates = [Named(words.format(width), _window(asked.truth, width, value)) for width in widths]
    return max(candidates, key=lambda each: asked.met(each.answers))


def _window(truth: np.ndarray, width: int, value: object) -> np.ndarray:
    assert callable(value)
    return np.array([value(truth[max(0, i - width + 1) : i + 1]) for i in range(len(truth))], dtype=float)
