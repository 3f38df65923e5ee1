"""Where a robot truly was: its poses in the simulator, between the recorded ticks, too."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gz_course.grader.record.reading import Recording

Array = np.ndarray


def true_poses(recording: Recording, times: Array, names: Sequence[str] = ("x", "y", "yaw")) -> Array:
    """Return true values of the robot, x, y, z [m] or yaw [rad], at times [s], shape (times, names), interpolated.

    They are zeros if the run ended before its first tick.
    """
    signals = [recording.signal(f"truth/robot/{name}") for name in names]
    if not len(signals[0]):
        return np.zeros((len(times), len(names)))
    return np.stack([np.interp(times, signal.times / 1e9, signal.values) for signal in signals], 1)


def heading(quaternion: Array) -> float:
    """Return the heading [rad] of a quaternion x, y, z, w."""
    x, y, z, w = quaternion
    return float(np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)))
