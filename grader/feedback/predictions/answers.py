"""Explanations of numbers that answer questions, such as the scans of a lidar.

A prediction is a function of `Asked`: what a program with one misconception would have answered to each question. It is
registered with the words that end the sentence "your answers are ...":

    @predicts("the largest valid range, not the smallest", only=("minimum",))
    def largest(asked: Asked) -> np.ndarray: ...

One that is a single expression is a line: `predict("rounded", lambda asked: np.round(asked.truth))`. A prediction with
a number in it returns `Named`, with words that name the number.

A notice is a function that looks at which questions were answered and returns a sentence itself (`@notices`).

What fits the answers to one question may not fit those to another about the same scans: `agreed` keeps the predictions
that fit most of them.
"""

from __future__ import annotations

import dataclasses
import warnings
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TypeVar

import numpy as np

from gz_course.grader.feedback.rules import Room, ask

FEWEST = 4  # answers; fewer may fit by chance
NEARLY_ALL = 0.9
LAST = 3
MEAN, COUNT, MINIMUM = "mean", "valid_count", "minimum"  # statistics of a scan
LENGTHS = (MINIMUM, MEAN)
MOST = 2  # explanations that are named
MOST_WRONG = 0.8  # of all answers, where some are right
SAMPLED = 0.8  # of the steps between answers, that are equal
# Predictions that fit if a timer answers with the scan that it has, which is an earlier one.
EARLIER = frozenset({
    "scan_before", "two_before", "long_before", "smoothed_over_two", "moving_average", "moving_median", "low_pass",
    "smallest_of_a_few", "largest_of_a_few", "same_again",
})  # fmt: skip


def nearest_ray(row: np.ndarray, low: float, high: float) -> int:
    return int(np.where((row > low) & (row < high), row, np.inf).argmin())


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
        return _each(value, zip(self.rows, self.low.tolist(), self.high.tolist(), strict=True), len(self.rows))

    def each_valid(self, value: Callable[[np.ndarray], float]) -> np.ndarray:
        """Return `value(valid ranges)` for every scan; NaN where it is not defined."""
        return _each(value, zip(self.valid, strict=True), len(self.rows))

    @cached_property
    def valid(self) -> list[np.ndarray]:
        return [row[(row > low) & (row < high)] for row, low, high in zip(self.rows, self.low, self.high, strict=True)]


def _each(value: Callable[..., float], scans: Iterable[tuple[object, ...]], number: int) -> np.ndarray:
    found = np.full(number, np.nan)
    with np.errstate(all="ignore"):
        for i, scan in enumerate(scans):
            try:
                found[i] = value(*scan)
            except (ValueError, IndexError, ZeroDivisionError):
                continue
    return found


@dataclass(frozen=True)
class Asked:
    """Questions with their true answers and those that were given: one row a question.

    `answered` marks questions with an answer; `given` is NaN where there is none, or where the answer was no finite
    number and nothing more is known of it. `given` is the first answer to each question, `last` the last one, `number`
    how many there were, `spread` how far they are apart.
    """

    statistic: str  # name of what is asked for, such as `minimum`
    times: np.ndarray  # [s]
    truth: np.ndarray
    given: np.ndarray
    answered: np.ndarray
    tolerance: float
    of: Callable[[np.ndarray], float] = field(default=lambda valid: float(valid.min()))  # the statistic of valid ranges
    scans: Scans | None = None
    last: np.ndarray | None = None
    number: np.ndarray | None = None
    spread: np.ndarray | None = None

    @property
    def unknown(self) -> np.ndarray:
        """Return no answer, NaN, to every question: the prediction of a function that cannot tell."""
        return np.full(len(self.truth), np.nan)

    @property
    def nearest(self) -> np.ndarray:
        """Return the index of the ray with the smallest valid range, for each scan."""
        return self.each(nearest_ray)

    def each(self, value: Callable[[np.ndarray, float, float], float]) -> np.ndarray:
        """Return `value(ranges, low, high)` for every scan; NaN where it is not defined."""
        return self.unknown if self.scans is None else self.scans.each(value)

    def of_rows(self, value: Callable[[np.ndarray], float]) -> np.ndarray:
        return self.each(lambda row, low, high: float(value(row)))

    def of_valid(self, value: Callable[[np.ndarray], float]) -> np.ndarray:
        return self.unknown if self.scans is None else self.scans.each_valid(value)

    def over(self, choice: Callable[[np.ndarray, float, float], np.ndarray]) -> np.ndarray:
        """Return the statistic that is asked for over the chosen ranges of each scan."""
        return self.each(lambda row, low, high: self.of(choice(row, low, high)))

    def met(self, answers: np.ndarray) -> int:
        """Return how many of the given answers these predict."""
        with np.errstate(invalid="ignore"):
            return int(np.sum(np.abs(answers - self.given) <= self.tolerance))


@dataclass(frozen=True)
class Named:
    """Predicted answers with the words that end the sentence "your answers are ..."."""

    words: str
    answers: np.ndarray


Prediction = Callable[[Asked], "np.ndarray | Named"]
Function = TypeVar("Function", bound=Prediction)
Notice = Callable[[Asked], str]
ROOM: Room[tuple[int, str, frozenset[str], Prediction]] = Room(f"{__name__.rpartition('.')[0]}.of_answers")
NOTICES: Room[Notice] = Room(ROOM.package)


def predicts(words: str, only: Sequence[str] = (), rank: int = 1) -> Callable[[Function], Function]:
    """Register a prediction, for these statistics only; `words` end the sentence "your answers are ...".

    Of several that fit those of the lowest rank are named first: 0 is for one that hardly fits by chance, 2 for one
    that chooses among several numbers, 3 (`LAST`) for one that is named only if no other fits.
    """

    def register(function: Function) -> Function:
        ROOM.add((rank, words, frozenset(only), function), function)
        return function

    return register


def predict(words: str, answers: Prediction, only: Sequence[str] = (), rank: int = 1) -> None:
    """Register a prediction that is one expression, `lambda asked: ...`; its words are its name, too."""
    answers.__name__ = answers.__qualname__ = words
    predicts(words, only, rank)(answers)


def notices(function: Notice) -> Notice:
    """Register a function that returns a sentence about the answers, without its full stop, or an empty text."""
    NOTICES.add(function, function)
    return function


@dataclass(frozen=True)
class Cause:
    """A prediction that fits: its rank, its words, which may hold a number, and the name of its function."""

    rank: int
    words: str
    name: str


@dataclass(frozen=True)
class Explanation:
    """A sentence without its full stop; `{}` in it stands for the causes that are named.

    `causes` are all that fit.
    """

    sentence: str = ""
    causes: tuple[Cause, ...] = ()

    def __str__(self) -> str:
        return self.sentence.replace("{}", ", or ".join(self.named))

    @property
    def named(self) -> list[str]:
        likely = [cause.words for cause in self.causes if cause.rank < LAST]
        return (likely or [cause.words for cause in self.causes])[:MOST]


def agreed(explanations: Sequence[Explanation]) -> list[Explanation]:
    """Keep in each explanation the causes that fit most of them, if one fits several: the others fit by chance."""
    times = Counter(name for each in explanations for name in {cause.name for cause in each.causes})
    most = max(times.values(), default=1)
    if most < 2:
        return list(explanations)
    kept = [tuple(cause for cause in each.causes if times[cause.name] == most) for each in explanations]
    return [
        dataclasses.replace(each, causes=causes or each.causes) for each, causes in zip(explanations, kept, strict=True)
    ]


def explain(asked: Asked) -> Explanation:
    """Return which misconceptions fit the answers, as the beginning of a sentence; empty if none does."""
    said = next(filter(None, (ask(notice, "", asked) for notice in NOTICES.rules())), "").replace("{}", "")
    wrong = asked.answered & ~_equal(asked.given, asked.truth, asked.tolerance)
    if asked.answered.sum() < FEWEST or not wrong.any() or _differing(asked):
        return Explanation(said)
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore", RuntimeWarning)  # such as the mean of no ranges, which is NaN
        causes = _fitting(asked, wrong)
        told = "your answers are {}"
        if not causes:
            told, causes = _where_wrong(asked, wrong)
    if said and sampled(asked) and {cause.name for cause in causes} <= EARLIER:
        told, causes = "", []  # what a timer takes up is some scan before that at which it answers
    both = (said, told) if told.startswith("where") or sampled(asked) else (told, said)
    return Explanation("; ".join(filter(None, both)), tuple(causes))


def sampled(asked: Asked) -> bool:
    """Return whether the answers come at even intervals that are longer than those of the questions."""
    answered = np.flatnonzero(asked.answered)
    steps = np.diff(answered)
    if len(steps) < 2 or np.median(steps) < 2:
        return False
    return bool(np.mean(np.abs(steps - np.median(steps)) <= 1) >= SAMPLED)


def _differing(asked: Asked) -> bool:
    """Return whether most questions have several answers, and not the same ones."""
    return asked.spread is not None and bool(np.mean(asked.spread[asked.answered] > asked.tolerance) > 0.5)


def _fitting(asked: Asked, wrong: np.ndarray) -> list[Cause]:
    """Return the predictions that fit."""
    found: list[Cause] = []
    for rank, words, only, prediction in sorted(ROOM.rules(), key=lambda each: each[0]):
        if only and asked.statistic not in only:
            continue
        if rank == LAST and len(found) == 1 and np.isfinite(asked.given[asked.answered]).any():
            break  # it need not be told from others, as an infinite answer must
        predicted = ask(prediction, asked.unknown, asked)
        if not isinstance(predicted, Named):
            predicted = Named(words, predicted)
        if _fits(asked, wrong, np.asarray(predicted.answers, dtype=float)):
            found.append(Cause(rank, predicted.words, prediction.__name__))
    return found


def _where_wrong(asked: Asked, wrong: np.ndarray) -> tuple[str, list[Cause]]:
    """Explain wrong answers among right ones: say where they are, and what they are if that is known."""
    known = np.flatnonzero(asked.answered)
    amiss = wrong[known]
    if not FEWEST <= amiss.sum() <= MOST_WRONG * len(amiss):
        return "", []
    first, last = np.flatnonzero(amiss)[[0, -1]]
    where = "where they are wrong,"
    if amiss[first:].all():
        where = f"right until {asked.times[known[first]]:.2f} s; from then on they are"
    elif amiss[: last + 1].all():
        where = f"right from {asked.times[known[last + 1]]:.2f} s on; before, they are"
    found = _fitting(dataclasses.replace(asked, answered=wrong), wrong)
    if where.startswith("where"):
        return (f"{where} your answers are {{}}", found) if found else ("", [])
    return f"your answers are {where} {'{}' if found else 'wrong'}", found


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
