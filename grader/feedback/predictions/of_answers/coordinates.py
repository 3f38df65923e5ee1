"""Coordinates of the points that the rays hit, where their ranges are asked for."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from gz_course.grader.feedback.predictions.answers import LAST, LENGTHS, MEAN, MINIMUM, Asked, nearest_ray, predicts


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


@predicts("x of the nearest point, range * cos(angle), not its range", only=(MINIMUM,))
def x_of_the_nearest(asked: Asked) -> np.ndarray:
    return _of_nearest(asked, np.cos)


@predicts("y of the nearest point, range * sin(angle), not its range", only=(MINIMUM,))
def y_of_the_nearest(asked: Asked) -> np.ndarray:
    return _of_nearest(asked, np.sin)


@predicts("the smallest x of all points, range * cos(angle), not the smallest range", only=(MINIMUM,))
def smallest_x(asked: Asked) -> np.ndarray:
    return _along(asked, np.cos, np.min)


@predicts(
    "the smallest distance in x of all points, range * |cos(angle)|, not the smallest range", only=(MINIMUM,), rank=LAST
)
def smallest_distance_in_x(asked: Asked) -> np.ndarray:
    return _along(asked, lambda angle: np.abs(np.cos(angle)), np.min)


@predicts(
    "the smallest distance in y of all points, range * |sin(angle)|, not the smallest range", only=(MINIMUM,), rank=LAST
)
def smallest_distance_in_y(asked: Asked) -> np.ndarray:
    return _along(asked, lambda angle: np.abs(np.sin(angle)), np.min)


@predicts("the average x of all points, range * cos(angle), not the average range", only=(MEAN,))
def average_x(asked: Asked) -> np.ndarray:
    return _along(asked, np.cos, np.mean)


@predicts("the average y of all points, range * sin(angle), not the average range", only=(MEAN,))
def average_y(asked: Asked) -> np.ndarray:
    return _along(asked, np.sin, np.mean)


@predicts("the distance of the middle of all points, not the average of their ranges", only=LENGTHS)
def distance_of_the_middle(asked: Asked) -> np.ndarray:
    return np.hypot(_along(asked, np.cos, np.mean), _along(asked, np.sin, np.mean))
