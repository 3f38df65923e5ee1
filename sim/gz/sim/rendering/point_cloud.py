"""Packs point clouds into gz.msgs.PointCloudPacked, for lidars and depth cameras.

The layout is that of Gazebo Harmonic: x, y, z as float32 at bytes 0, 4, 8, the fourth field at byte 16, and 32 bytes
per point (24 with a colour), so that each field starts at a multiple of 16.

Source: https://github.com/gazebosim/gz-sensors/blob/gz-sensors8/src/PointCloudUtil.cc
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

LIDAR = np.dtype(
    {
        "names": ["x", "y", "z", "intensity", "ring"],
        "formats": ["<f4", "<f4", "<f4", "<f4", "<u2"],
        "offsets": [0, 4, 8, 16, 24],
        "itemsize": 32,
    }
)
"""One point of a lidar: position [m] in the sensor's frame, `laser_retro`, and number of the row from the lowest, 0."""

COLOURED = np.dtype(
    {
        "names": ["x", "y", "z", "rgb"],
        "formats": ["<f4", "<f4", "<f4", "<u4"],
        "offsets": [0, 4, 8, 16],
        "itemsize": 24,
    }
)
"""One point of a depth camera: position [m] in the sensor's frame (x forward), colour as 0x00RRGGBB."""


def pack_rgb(colours: NDArray[np.uint8]) -> NDArray[np.uint32]:
    """Return colours (3, n) as 0x00RRGGBB (n,)."""
    red, green, blue = colours.astype(np.uint32)
    packed: NDArray[np.uint32] = (red << 16) | (green << 8) | blue
    return packed


def fill_cloud(message: Any, points: NDArray[Any], height: int, width: int) -> None:
    """Write `points` (height * width, of dtype LIDAR or COLOURED) into a PointCloudPacked, without the header."""
    kinds = message.Field
    types = {"float32": kinds.FLOAT32, "uint16": kinds.UINT16, "uint32": kinds.FLOAT32}
    fields = points.dtype.fields
    assert fields is not None
    for name in points.dtype.names or ():
        kind, offset = fields[name][:2]
        message.field.add(name=name, offset=offset, datatype=types[kind.name], count=1)
    message.height, message.width = height, width
    message.point_step = points.dtype.itemsize
    message.row_step = points.dtype.itemsize * width
    message.is_bigendian = False
    finite = np.isfinite(points["x"]) & np.isfinite(points["y"]) & np.isfinite(points["z"])
    message.is_dense = bool(finite.all())
    message.data = points.tobytes()
