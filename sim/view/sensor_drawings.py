"""Messages of sensors as drawings: the rays of a scan as lines in the world, a picture as RGB.

Source: https://github.com/gazebosim/gz-msgs/blob/gz-msgs10/proto/gz/msgs/laserscan.proto
Source: https://github.com/gazebosim/gz-msgs/blob/gz-msgs10/proto/gz/msgs/image.proto (PixelFormatType)
"""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np

MOST_RAYS = 240
_RGBA = np.array([0.1, 0.35, 0.95, 0.7], np.float32)
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
    if not 0 < height * width <= 1 << 24:
        return None
    if kind in (message.RGB_INT8, message.BGR_INT8) and len(message.data) == height * width * 3:
        pixels = np.frombuffer(message.data, np.uint8).reshape(height, width, 3)
        return pixels if kind == message.RGB_INT8 else pixels[:, :, ::-1]
    if kind == message.L_INT8 and len(message.data) == height * width:
        grey = np.frombuffer(message.data, np.uint8).reshape(height, width)
    elif kind in (message.R_FLOAT32, message.L_INT16):
        numbers = np.frombuffer(message.data, np.float32 if kind == message.R_FLOAT32 else np.uint16)
        if len(numbers) != height * width:
            return None
        values = np.where(np.isfinite(numbers), numbers, 0.0)
        most = float(values.max()) or 1.0
        grey = (values * (255.0 / most)).clip(0.0, 255.0).astype(np.uint8).reshape(height, width)
    else:
        return None
    return np.repeat(grey[:, :, None], 3, axis=2)
