"""Explanations of numbers that answer questions, such as the scans of a lidar.

A prediction is a function of `Asked`: what a program with one misconception would have answered to each question. It is
registered with the words that end the sentence "your answers are ...":

    @predicts("the largest valid range, not the smallest", only=("minimum",))
    def largest(asked: Asked) -> np.ndarray: ...

A notice is a function that looks at which questions were answered and returns a sentence itself (`@notices`).
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cache

import numpy as np

from gz_course.grader.registry import modules

FEWEST = 4  # answers; fewer may fit by chance
NEARLY_ALL = 0.9
LAST = 3
MOST = 2  # explanations that are named


@dataclass(frozen=True)
class Scans:
    """The scans behind the questions: ranges [m], one row a scan; their bounds [m] and angles [rad], shape (n,)."""

    rows: Sequence[np.ndarray]
    low: np.ndarray
    high: np.ndarray
    angle_min: np.ndarray
    angle_max: np.ndarray

    def each(self, value: Callable[[np.ndarray, float, float], float]) -> np.ndarray:
        """Return `value(ranges, low, high)` for every scan; NaN where it is not defined."""
        found = np.full(len(self.rows), np.nan)
        for i, row in enumerate(self.rows):
            try:
                with np.errstate(all="ignore"):
                    found[i] = value(row, float(self.low[i]), float(self.high[i]))
            except (ValueError, IndexError, ZeroDivisionError):
                continue
        return found

    def valid(self) -> list[np.ndarray]:
        return [row[(row > low) & (row < high)] for row, low, high in zip(self.rows, self.low, self.high, strict=True)]


@dataclass(frozen=True)
class Asked:
    """Questions with their true answers and those that were given: one row a question.

    `answered` marks questions with an answer; `given` is NaN where there is none, or where the answer was no finite
    number and nothing more is known of it.
    """

    statistic: str  # name of what is asked for, such as `minimum`
    times: np.ndarray  # [s]
    truth: np.ndarray
    given: np.ndarray
    answered: np.ndarray
    tolerance: float
    of: Callable[[np.ndarray], float] = field(default=lambda valid: float(valid.min()))  # the statistic of valid ranges
    scans: Scans | None = None


Prediction = Callable[[Asked], np.ndarray]
Notice = Callable[[Asked], str]
_predictions: list[tuple[int, str, frozenset[str], Prediction]] = []
_notices: list[Notice] = []


def predicts(words: str, only: Sequence[str] = (), rank: int = 1) -> Callable[[Prediction], Prediction]:
    """Register a prediction, for these statistics only; `words` end the sentence "your answers are ...".

    Of several that fit those of the lowest rank are named first: 0 is for one that hardly fits by chance, 2 for one
    that chooses among several numbers, 3 (`LAST`) for one that is named only if no other fits.
    """

    def register(function: Prediction) -> Prediction:
        _predictions.append((rank, words, frozenset(only), function))
        return function

    return register


def notices(function: Notice) -> Notice:
    """Register a function that returns a sentence about the answers, without its full stop, or an empty text."""
    _notices.append(function)
    return function


@cache
def _load() -> None:
    from gz_course.grader.score.explanations import of_answers

    modules(of_answers)


def explain(asked: Asked) -> str:
    """Return which misconceptions fit the answers, as the beginning of a sentence; empty if none does."""
    _load()
    said = next(filter(None, (notice(asked) for notice in _notices)), "")
    wrong = asked.answered & ~_equal(asked.given, asked.truth, asked.tolerance)
    if asked.answered.sum() < FEWEST or not wrong.any():
        return said
    found: list[str] = []
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore", RuntimeWarning)  # such as the mean of no ranges, which is NaN
        for rank, words, only, prediction in sorted(_predictions, key=lambda each: each[0]):
            if only and asked.statistic not in only:
                continue
            if rank == LAST and found:
                break
            if _fits(asked, wrong, np.asarray(prediction(asked), dtype=float)):
                found.append(words)
    told = f"your answers are {', or '.join(found[:MOST])}" if found else ""
    return "; ".join(filter(None, (told, said)))


def _equal(given: np.ndarray, wanted: np.ndarray, tolerance: float) -> np.ndarray:
    with np.errstate(invalid="ignore"):
        near = np.abs(given - wanted) <= tolerance
    # an infinite prediction is met by the same infinity, or by an answer of which only that is known
    return np.asarray(near | (np.isinf(wanted) & ((given == wanted) | np.isnan(given))))


def _fits(asked: Asked, wrong: np.ndarray, wanted: np.ndarray) -> bool:
    """Return whether a prediction meets nearly all answers, nearly all wrong ones among them, closely enough."""
    known = asked.answered & ~np.isnan(wanted)
    if known.sum() < max(FEWEST, 0.7 * asked.answered.sum()) or not (known & wrong).any():
        return False
    met = _equal(asked.given, wanted, asked.tolerance)
    return bool(met[known].mean() >= NEARLY_ALL and met[known & wrong].mean() >= NEARLY_ALL)
