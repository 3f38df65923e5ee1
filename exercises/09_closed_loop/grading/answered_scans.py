"""The scans of a run along the wall, and what the commands that answered them make of the nearest point."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from . import steering

if TYPE_CHECKING:
    from .wall import Run

SETTLED, KEPT = 7.0, 0.08  # [s] after the start; [m] within which a distance is kept


def point_and_rates(run: Run, standing: bool = False) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the nearest points of the side in all scans that were answered, the turning rates and the distances.

    Those in which the robot stands, such as against a wall, are left out: they are one scan many times over.
    """
    times, bearings, ranges = scans(run)
    heard, rates, asked = steering.answered(run, times)
    point, chosen = steering.measured(bearings, ranges[heard])["right"], moving(run) | standing
    return point[chosen], rates[chosen], asked[chosen]


def ahead_of(run: Run, times: np.ndarray) -> np.ndarray:
    """Return linear.x [m/s] of the commands that answer the scans of these times [s]."""
    signal = run.recording.signal("topics/cmd_vel/linear/x")
    index = np.searchsorted(signal.times / 1e9, times) + run.lag
    return signal.values[np.minimum(index, len(signal.values) - 1)]


def moving(run: Run) -> np.ndarray:
    """Return at which of the answered scans the robot moves."""
    times = scans(run)[0]
    speed = np.interp(times, run.times, np.abs(run.speed)) + 0.2 * np.interp(times, run.times, np.abs(run.turning))
    return speed[steering.answered(run, times)[0]] > 0.03


def scans(run: Run) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return times [s] (n,), bearings from ahead towards the side [rad] (m,) and ranges [m] (n, m) of all scans."""
    times, ranges = run.recording.arrays("topics/lidar/scan/ranges")
    first = run.recording.signal("topics/lidar/scan/angle_min").values
    step = run.recording.signal("topics/lidar/scan/angle_increment").values
    if not len(times):
        return np.empty(0), np.empty(0), np.empty((0, 0))
    return times / 1e9, run.sign * (first[0] + step[0] * np.arange(len(ranges[0]))), np.array(ranges)
