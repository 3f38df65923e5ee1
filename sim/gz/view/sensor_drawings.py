"""Messages of sensors as drawings: the rays of a scan as lines in the world, a picture as RGB.

Source: https://github.com/gazebosim/gz-msgs/blob/gz-msgs10/proto/gz/msgs/laserscan.proto
Source: https://github.com/gazebosim/gz-msgs/blob/gz-msgs10/proto/gz/msgs/image.proto (PixelFormatType)
"""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np

from gz_course.sim.gz.msgs.image_pb2 import BGR_INT8, L_INT8, L_INT16, R_FLOAT32, RGB_INT8

MOST_RAYS = 240
_RGBA = np.array([0.1, 0.35, 0.95, 0.7], np.float32)
_MOST_PIXELS = 1 << 24
_FORMATS: dict[int, tuple[np.dtype[Any], int]] = {
    RGB_INT8: (np.dtype(np.uint8), 3),
    BGR_INT8: (np.dtype(np.uint8), 3),
    L_INT8: (np.dtype(np.uint8), 1),
    L_INT16: (np.dtype("<u2"), 1),
    R_FLOAT32: (np.dtype("<f4"), 1),
}
"""Number type and channels of the pixel formats that are shown."""
_WIDTH = 0.004
"""Radius of a ray [m]."""


def rays_of(message: Any) -> list[mujoco.MjvGeom]:
    """Return the rays of a gz.msgs.LaserScan that hit something, at most MOST_RAYS, in the frame of the world."""
    ranges = np.asarray(message.ranges)
    rows = max(1, message.vertical_count)
    if not len(ranges) or len(ranges) % rows:
        return []
    columns = len(ranges) // rows
    across = message.angle_min + message.angle_step * np.arange(columns)
    up = message.vertical_angle_min + message.vertical_angle_step * np.arange(rows)
    azimuth, elevation = (each.ravel() for each in np.meshgrid(across, up))
    directions = np.stack(
        (np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)), axis=1
    )
    hits = np.flatnonzero(np.isfinite(ranges) & (ranges >= message.range_min) & (ranges <= message.range_max))
    chosen = hits[:: max(1, -(-len(hits) // MOST_RAYS))]
    place, turn = message.world_pose.position, message.world_pose.orientation
    origin = np.array((place.x, place.y, place.z))
    matrix = np.zeros(9)
    mujoco.mju_quat2Mat(matrix, np.array((turn.w, turn.x, turn.y, turn.z)))
    ends = origin + (directions[chosen] * ranges[chosen, None]) @ matrix.reshape(3, 3).T
    return [line(origin, end, _RGBA, _WIDTH) for end in ends]


def line(start: np.ndarray, end: np.ndarray, rgba: np.ndarray, width: float) -> mujoco.MjvGeom:
    """Return a thin capsule between two points [m]; `width` is its radius [m]."""
    geom = mujoco.MjvGeom()
    mujoco.mjv_initGeom(geom, mujoco.mjtGeom.mjGEOM_CAPSULE, np.zeros(3), np.zeros(3), np.zeros(9), rgba)
    mujoco.mjv_connector(geom, mujoco.mjtGeom.mjGEOM_CAPSULE, width, start, end)
    return geom


def pixels_of(message: Any) -> np.ndarray | None:
    """Return a gz.msgs.Image as RGB, (height, width, 3) bytes; None for a format that is not shown."""
    height, width, kind = message.height, message.width, message.pixel_format_type
    known = _FORMATS.get(kind)
    if known is None or not 0 < height * width <= _MOST_PIXELS:
        return None
    number, channels = known
    if len(message.data) != height * width * channels * number.itemsize:
        return None
    pixels = np.frombuffer(message.data, number).reshape(height, width, channels)
    if kind == BGR_INT8:
        pixels = pixels[:, :, ::-1]
    if number != np.uint8:  # a depth: the farther, the brighter
        values = np.where(np.isfinite(pixels), pixels, 0.0)
        pixels = (values * (255.0 / (float(values.max()) or 1.0))).clip(0.0, 255.0).astype(np.uint8)
    return np.ascontiguousarray(np.broadcast_to(pixels, (height, width, 3)))
