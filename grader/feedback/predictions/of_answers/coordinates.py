"""Coordinates of the points that the rays hit, where their ranges are asked for."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from gz_course.grader.feedback.predictions.answers import (
    LAST,
    LENGTHS,
    MEAN,
    MINIMUM,
    Asked,
    nearest_ray,
    predict,
)


def _along(
    asked: Asked, function: Callable[[np.ndarray], np.ndarray], value: Callable[[np.ndarray], float]
) -> np.ndarray:
    """Return `value` of the valid ranges, each times `function` of the angle of its ray."""
    scans = asked.scans
    if scans is None:
        return asked.unknown
    first, last = float(scans.angle_min[0]), float(scans.angle_max[0])

    def of(row: np.ndarray, low: float, high: float) -> float:
        valid = (row > low) & (row < high)
        return float(value(row[valid] * function(np.linspace(first, last, len(row)))[valid]))

    return scans.each(of)


def _of_nearest(asked: Asked, function: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    scans = asked.scans
    if scans is None:
        return asked.unknown
    first, last = float(scans.angle_min[0]), float(scans.angle_max[0])

    def of(row: np.ndarray, low: float, high: float) -> float:
        ray = nearest_ray(row, low, high)
        return float(row[ray] * function(np.linspace(first, last, len(row)))[ray])

    return scans.each(of)


predict(
    "x of the nearest point, range * cos(angle), not its range", lambda asked: _of_nearest(asked, np.cos), (MINIMUM,)
)
predict(
    "y of the nearest point, range * sin(angle), not its range", lambda asked: _of_nearest(asked, np.sin), (MINIMUM,)
)
predict(
    "the smallest x of all points, range * cos(angle), not the smallest range",
    lambda asked: _along(asked, np.cos, np.min),
    (MINIMUM,),
)
predict(
    "the smallest distance in x of all points, range * |cos(angle)|, not the smallest range",
    lambda asked: _along(asked, lambda angle: np.abs(np.cos(angle)), np.min),
    (MINIMUM,),
    rank=LAST,
)
predict(
    "the smallest distance in y of all points, range * |sin(angle)|, not the smallest range",
    lambda asked: _along(asked, lambda angle: np.abs(np.sin(angle)), np.min),
    (MINIMUM,),
    rank=LAST,
)
predict(
    "the average x of all points, range * cos(angle), not the average range",
    lambda asked: _along(asked, np.cos, np.mean),
    (MEAN,),
)
predict(
    "the average y of all points, range * sin(angle), not the average range",
    lambda asked: _along(asked, np.sin, np.mean),
    (MEAN,),
)
predict(
    "the distance of the middle of all points, not the average of their ranges",
    lambda asked: np.hypot(_along(asked, np.cos, np.mean), _along(asked, np.sin, np.mean)),
    LENGTHS,
)
