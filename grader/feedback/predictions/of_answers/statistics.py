"""Another statistic of the valid ranges than the one asked for, or no statistic at all."""

from __future__ import annotations

import numpy as np

from gz_course.grader.feedback.predictions.answers import COUNT, MEAN, MINIMUM, Asked, predicts


@predicts("the smallest valid range", only=(MEAN, COUNT))
def smallest(asked: Asked) -> np.ndarray:
    return asked.of_valid(np.min)


@predicts("the largest valid range", only=(MINIMUM, MEAN, COUNT))
def largest(asked: Asked) -> np.ndarray:
    return asked.of_valid(np.max)


@predicts("the average of the valid ranges, not the smallest of them", only=(MINIMUM, COUNT))
def average(asked: Asked) -> np.ndarray:
    return asked.of_valid(np.mean)


@predicts("the median of the valid ranges", only=(MINIMUM, MEAN, COUNT))
def median(asked: Asked) -> np.ndarray:
    return asked.of_valid(np.median)


@predicts("the middle between the smallest and the largest valid range", only=(MINIMUM, MEAN))
def middle(asked: Asked) -> np.ndarray:
    return asked.of_valid(lambda valid: (valid.min() + valid.max()) / 2)


@predicts("the sum of the valid ranges: it is not divided by their number", only=(MINIMUM, MEAN, COUNT))
def total(asked: Asked) -> np.ndarray:
    return asked.of_valid(np.sum)


@predicts("the standard deviation of the valid ranges", only=(MINIMUM, MEAN))
def spread(asked: Asked) -> np.ndarray:
    return asked.of_valid(np.std)


@predicts("the number of valid rays", only=(MINIMUM, MEAN))
def number(asked: Asked) -> np.ndarray:
    return asked.of_valid(len)


@predicts("the number of all rays, the invalid ones included", only=(MINIMUM, MEAN))
def number_of_all(asked: Asked) -> np.ndarray:
    return asked.of_rows(len)


@predicts("the number of rays that are not valid", only=(COUNT,))
def number_of_invalid(asked: Asked) -> np.ndarray:
    return asked.of_rows(len) - asked.truth


@predicts("one less than the number of valid rays, such as the last index, or a ray is left out", only=(COUNT,))
def last_index(asked: Asked) -> np.ndarray:
    return asked.truth - 1


@predicts("one more than the number of valid rays", only=(COUNT,))
def one_more(asked: Asked) -> np.ndarray:
    return asked.truth + 1


@predicts("the second smallest valid range", only=(MINIMUM,))
def second_smallest(asked: Asked) -> np.ndarray:
    return asked.of_valid(lambda valid: np.partition(valid, 1)[1])


@predicts("the index of the nearest ray, not its range", only=(MINIMUM,))
def index(asked: Asked) -> np.ndarray:
    return asked.nearest


@predicts("those of the numbers of the valid rays, 0, 1, 2 ..., not of their ranges", only=(MINIMUM, MEAN))
def of_numbers(asked: Asked) -> np.ndarray:
    return asked.each(lambda row, low, high: asked.of(np.flatnonzero((row > low) & (row < high)).astype(float)))


@predicts("the index of the smallest of all ranges, the invalid ones included, and not a range", only=(MINIMUM,))
def index_of_all(asked: Asked) -> np.ndarray:
    return asked.of_rows(np.argmin)


@predicts("the index of the nearest among the valid rays, not its range", only=(MINIMUM,))
def index_among_valid(asked: Asked) -> np.ndarray:
    return asked.of_valid(np.argmin)


@predicts("the angle [rad] of the nearest ray, not its range", only=(MINIMUM,))
def angle(asked: Asked) -> np.ndarray:
    if asked.scans is None:
        return asked.unknown
    rays = asked.of_rows(len)
    step = (asked.scans.angle_max - asked.scans.angle_min) / (rays - 1)
    return asked.scans.angle_min + asked.nearest * step


@predicts("the angle of the nearest ray in degrees, not its range", only=(MINIMUM,))
def angle_in_degrees(asked: Asked) -> np.ndarray:
    return np.degrees(angle(asked))


@predicts("the range of the ray beside the nearest one: an index is off by one", only=(MINIMUM,), rank=2)
def beside(asked: Asked) -> np.ndarray:
    if asked.scans is None:
        return asked.unknown
    nearest = asked.nearest
    sides = [
        np.array([row[(int(i) + off) % len(row)] for row, i in zip(asked.scans.rows, nearest, strict=True)])
        for off in (-1, 1)
    ]
    off = [np.nanmean(np.abs(np.where(np.isfinite(side), side, np.nan) - asked.given)) for side in sides]
    return sides[int(np.nanargmin(off))] if np.isfinite(off).any() else sides[0]


@predicts("the range of the first ray, ranges[0]", only=(MINIMUM, MEAN))
def first_ray(asked: Asked) -> np.ndarray:
    return asked.of_rows(lambda row: row[0])


@predicts("the range of the last ray, ranges[-1]", only=(MINIMUM, MEAN))
def last_ray(asked: Asked) -> np.ndarray:
    return asked.of_rows(lambda row: row[-1])


@predicts("the range of the middle ray, the one straight ahead", only=(MINIMUM, MEAN))
def middle_ray(asked: Asked) -> np.ndarray:
    return asked.of_rows(lambda row: row[len(row) // 2])


@predicts("the first valid range, not the smallest", only=(MINIMUM, MEAN))
def first_valid(asked: Asked) -> np.ndarray:
    return asked.of_valid(lambda valid: valid[0])


@predicts("the last valid range, not the smallest", only=(MINIMUM, MEAN))
def last_valid(asked: Asked) -> np.ndarray:
    return asked.of_valid(lambda valid: valid[-1])


@predicts("range_min, the limit of the sensor, not the smallest range it measured", only=(MINIMUM, MEAN))
def limit_below(asked: Asked) -> np.ndarray:
    return asked.scans.low if asked.scans else asked.unknown


@predicts("range_max, the limit of the sensor", only=(MINIMUM, MEAN))
def limit_above(asked: Asked) -> np.ndarray:
    return asked.scans.high if asked.scans else asked.unknown
