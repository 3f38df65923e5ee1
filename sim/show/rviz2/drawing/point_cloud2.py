"""sensor_msgs/PointCloud2: points, in the colours of a field `rgb`, else by height."""

from __future__ import annotations

from typing import Any

import numpy as np

MOST_HZ = 10.0
MOST_POINTS = 50_000
RADIUS = 0.01  # [m]


def draw(canvas: Any, entity: str, message: Any) -> None:
    import rerun as rr

    from gz_course.sim.ros.sensor_msgs_py.point_cloud2 import read_points

    if not canvas.is_due(entity, MOST_HZ):
        return
    names = {each.name for each in message.fields}
    if not {"x", "y", "z"} <= names:
        canvas.say(f"{entity}: a cloud without x, y and z is not drawn")
        return
    read = read_points(message).ravel()
    read = read[:: len(read) // MOST_POINTS + 1]
    places = np.stack([np.asarray(read[name], dtype=np.float32) for name in ("x", "y", "z")], axis=1)
    kept = np.isfinite(places).all(axis=1)
    places = places[kept]
    if "rgb" in names:
        packed = np.ascontiguousarray(read["rgb"][kept]).view(np.uint32)
        colours = np.stack([packed >> 16 & 255, packed >> 8 & 255, packed & 255], axis=1).astype(np.uint8)
    else:
        colours = _by_height(places[:, 2])
    canvas.in_frame(entity, message.header.frame_id)
    canvas.log(entity, rr.Points3D(places, colors=colours, radii=RADIUS))


def _by_height(heights: np.ndarray) -> np.ndarray:
    """Return a colour (n, 3) for each height (n,), from blue to green."""
    share = (heights - heights.min()) / max(float(np.ptp(heights)), 1e-6) if len(heights) else heights
    return np.stack([np.full(len(share), 60), 90 + 150 * share, 230 - 150 * share], axis=1).astype(np.uint8)


DRAWN = {"sensor_msgs/msg/PointCloud2": draw}
