"""Another statistic of the valid ranges than the one asked for, or no statistic at all."""

from __future__ import annotations

import numpy as np

from gz_course.grader.feedback.predictions.answers import COUNT, MEAN, MINIMUM, Asked, predict, predicts

predict("the smallest valid range", lambda asked: asked.of_valid(np.min), (MEAN, COUNT))
predict("the largest valid range", lambda asked: asked.of_valid(np.max), (MINIMUM, MEAN, COUNT))
predict(
    "the average of the valid ranges, not the smallest of them", lambda asked: asked.of_valid(np.mean), (MINIMUM, COUNT)
)
predict("the median of the valid ranges", lambda asked: asked.of_valid(np.median), (MINIMUM, MEAN, COUNT))
predict(
    "the middle between the smallest and the largest valid range",
    lambda asked: asked.of_valid(lambda valid: (valid.min() + valid.max()) / 2),
    (MINIMUM, MEAN),
)
predict(
    "the sum of the valid ranges: it is not divided by their number",
    lambda asked: asked.of_valid(np.sum),
    (MINIMUM, MEAN, COUNT),
)
predict("the standard deviation of the valid ranges", lambda asked: asked.of_valid(np.std), (MINIMUM, MEAN))
predict("the number of valid rays", lambda asked: asked.of_valid(len), (MINIMUM, MEAN))
predict("the number of all rays, the invalid ones included", lambda asked: asked.of_rows(len), (MINIMUM, MEAN))
predict("the number of rays that are not valid", lambda asked: asked.of_rows(len) - asked.truth, (COUNT,))
predict(
    "one less than the number of valid rays, such as the last index, or a ray is left out",
    lambda asked: asked.truth - 1,
    (COUNT,),
)
predict("one more than the number of valid rays", lambda asked: asked.truth + 1, (COUNT,))
predict(
    "the second smallest valid range", lambda asked: asked.of_valid(lambda valid: np.partition(valid, 1)[1]), (MINIMUM,)
)
predict("the index of the nearest ray, not its range", lambda asked: asked.nearest, (MINIMUM,))
predict(
    "those of the numbers of the valid rays, 0, 1, 2 ..., not of their ranges",
    lambda asked: asked.each(lambda row, low, high: asked.of(np.flatnonzero((row > low) & (row < high)).astype(float))),
    (MINIMUM, MEAN),
)
predict(
    "the index of the smallest of all ranges, the invalid ones included, and not a range",
    lambda asked: asked.of_rows(np.argmin),
    (MINIMUM,),
)
predict(
    "the index of the nearest among the valid rays, not its range", lambda asked: asked.of_valid(np.argmin), (MINIMUM,)
)


@predicts("the angle [rad] of the nearest ray, not its range", only=(MINIMUM,))
def angle(asked: Asked) -> np.ndarray:
    if asked.scans is None:
        return asked.unknown
    rays = asked.of_rows(len)
    step = (asked.scans.angle_max - asked.scans.angle_min) / (rays - 1)
    return asked.scans.angle_min + asked.nearest * step


predict("the angle of the nearest ray in degrees, not its range", lambda asked: np.degrees(angle(asked)), (MINIMUM,))


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


predict("the range of the first ray, ranges[0]", lambda asked: asked.of_rows(lambda row: row[0]), (MINIMUM, MEAN))
predict("the range of the last ray, ranges[-1]", lambda asked: asked.of_rows(lambda row: row[-1]), (MINIMUM, MEAN))
predict(
    "the range of the middle ray, the one straight ahead",
    lambda asked: asked.of_rows(lambda row: row[len(row) // 2]),
    (MINIMUM, MEAN),
)
predict(
    "the first valid range, not the smallest", lambda asked: asked.of_valid(lambda valid: valid[0]), (MINIMUM, MEAN)
)
predict(
    "the last valid range, not the smallest", lambda asked: asked.of_valid(lambda valid: valid[-1]), (MINIMUM, MEAN)
)
predict(
    "range_min, the limit of the sensor, not the smallest range it measured",
    lambda asked: asked.scans.low if asked.scans else asked.unknown,
    (MINIMUM, MEAN),
)
predict(
    "range_max, the limit of the sensor",
    lambda asked: asked.scans.high if asked.scans else asked.unknown,
    (MINIMUM, MEAN),
)
