"""Other averages and spreads of the valid ranges, and averages of ranges that were changed before."""

from __future__ import annotations

import numpy as np

from gz_course.grader.feedback.predictions.answers import COUNT, LENGTHS, MEAN, Asked, predicts


@predicts("the root mean square of the valid ranges", only=LENGTHS)
def root_mean_square(asked: Asked) -> np.ndarray:
    return asked.of_valid(lambda valid: np.sqrt(np.mean(valid**2)))


@predicts("the average of the squares of the valid ranges", only=LENGTHS)
def mean_square(asked: Asked) -> np.ndarray:
    return asked.of_valid(lambda valid: np.mean(valid**2))


@predicts("the harmonic mean of the valid ranges, n / sum(1 / r)", only=LENGTHS)
def harmonic_mean(asked: Asked) -> np.ndarray:
    return asked.of_valid(lambda valid: len(valid) / np.sum(1 / valid))


@predicts("the geometric mean of the valid ranges", only=LENGTHS)
def geometric_mean(asked: Asked) -> np.ndarray:
    return asked.of_valid(lambda valid: np.exp(np.mean(np.log(valid))))


@predicts("the variance of the valid ranges", only=LENGTHS)
def variance(asked: Asked) -> np.ndarray:
    return asked.of_valid(np.var)


@predicts("the difference between the largest and the smallest valid range", only=(*LENGTHS, COUNT))
def extent(asked: Asked) -> np.ndarray:
    return asked.of_valid(np.ptp)


@predicts("the largest difference between two rays side by side", only=LENGTHS)
def largest_jump(asked: Asked) -> np.ndarray:
    return asked.of_valid(lambda valid: np.abs(np.diff(valid)).max())


@predicts("the average of ranges that were cut to whole numbers first", only=(MEAN,))
def of_whole_numbers(asked: Asked) -> np.ndarray:
    return asked.of_valid(lambda valid: np.floor(valid).mean())


@predicts("the average of ranges that were rounded to whole numbers first", only=(MEAN,))
def of_rounded_numbers(asked: Asked) -> np.ndarray:
    return asked.of_valid(lambda valid: np.round(valid).mean())


@predicts("the average without the smallest and the largest valid range", only=(MEAN,), rank=2)
def without_the_extremes(asked: Asked) -> np.ndarray:
    return asked.of_valid(lambda valid: np.sort(valid)[1:-1].mean())


@predicts("the average of all pairs of rays side by side, half of each sum", only=(MEAN,), rank=2)
def without_half_of_the_ends(asked: Asked) -> np.ndarray:
    return asked.of_valid(lambda valid: float(np.mean((valid[1:] + valid[:-1]) / 2)))


@predicts("the number of different values among the valid ranges", only=(COUNT,))
def number_of_values(asked: Asked) -> np.ndarray:
    return asked.of_valid(lambda valid: len(np.unique(valid)))
