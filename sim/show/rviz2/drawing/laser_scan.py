"""sensor_msgs/LaserScan: a point for each ray that hit something."""

from __future__ import annotations

from typing import Any

import numpy as np

COLOUR = (230, 60, 200)
MOST_HZ = 15.0
RADIUS = 0.02  # [m]


def points(scan: Any) -> np.ndarray:
    """Return the points (n, 3) [m] of a scan in its own frame; rays without a finite range have none."""
    ranges = np.asarray(scan.ranges, dtype=np.float64)
    angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
    seen = np.isfinite(ranges)
    flat = np.stack([ranges[seen] * np.cos(angles[seen]), ranges[seen] * np.sin(angles[seen])], axis=1)
    return np.pad(flat, ((0, 0), (0, 1)))


def draw(canvas: Any, entity: str, message: Any) -> None:
    import rerun as rr

    if not canvas.is_due(entity, MOST_HZ):
        return
    canvas.in_frame(entity, message.header.frame_id)
    canvas.log(entity, rr.Points3D(points(message), colors=[COLOUR], radii=RADIUS))


DRAWN = {"sensor_msgs/msg/LaserScan": draw}
