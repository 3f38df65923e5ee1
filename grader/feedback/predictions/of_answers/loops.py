"""What a loop over the rays leaves in its variable if it ends too soon, or mixes each ray with those before."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from gz_course.grader.feedback.predictions.answers import LAST, LENGTHS, MEAN, MINIMUM, Asked, Named, predict, predicts

KEPT = (0.5, 0.9, 0.8, 0.7, 0.95)  # shares of the old value


def _valid(row: np.ndarray, low: float, high: float) -> np.ndarray:
    return np.asarray((row > low) & (row < high))


@predicts("those of the rays before the first invalid one: a break or return ends the loop there", rank=0)
def until_an_invalid_ray(asked: Asked) -> np.ndarray:
    def choice(row: np.ndarray, low: float, high: float) -> np.ndarray:
        valid = _valid(row, low, high)
        return row[: int(np.argmin(valid)) if not valid.all() else len(row)]

    return asked.over(choice)


@predicts("those of the rays after the last invalid one: the list is emptied at each invalid ray", rank=0)
def since_an_invalid_ray(asked: Asked) -> np.ndarray:
    def choice(row: np.ndarray, low: float, high: float) -> np.ndarray:
        invalid = np.flatnonzero(~_valid(row, low, high))
        return row[invalid[-1] + 1 if len(invalid) else 0 :]

    return asked.over(choice)


@predicts("a filter along the rays of a scan", only=LENGTHS)
def filtered_along_the_rays(asked: Asked) -> Named:
    words = "{:g} of the last result plus {:g} of each next ray: the last rays count most, which is no average"
    candidates = [
        Named(words.format(keep, 1 - keep), asked.of_valid(partial(_filtered, keep=keep, start=start)))
        for keep in KEPT
        for start in (None, 0.0)
    ]
    return max(candidates, key=lambda each: asked.met(each.answers))


def _filtered(valid: np.ndarray, keep: float, start: float | None) -> float:
    value = valid[0] if start is None else start
    for each in valid[-200:]:  # what came before has no weight
        value = keep * value + (1 - keep) * each
    return float(value)


predict(
    "the average of the different values among the valid ranges: a set holds each value once",
    lambda asked: max((asked.of_valid(partial(_distinct, digits=digits)) for digits in (1, 2, 0)), key=asked.met),
    (MEAN,),
    rank=2,
)


def _distinct(valid: np.ndarray, digits: int) -> float:
    return float(np.unique(np.round(valid, digits)).mean())


@predicts("the smallest of the averages of a few sectors, not of the ranges themselves", only=(MINIMUM,), rank=LAST)
def nearest_sector(asked: Asked) -> np.ndarray:
    def smallest(parts: int) -> Callable[[np.ndarray, float, float], float]:
        def value(row: np.ndarray, low: float, high: float) -> float:
            return min(float(part[_valid(part, low, high)].mean()) for part in np.array_split(row, parts))

        return value

    return max((asked.each(smallest(parts)) for parts in (2, 3, 4, 5, 6, 8, 10, 12, 16, 36)), key=asked.met)
