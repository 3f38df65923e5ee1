"""The projection of a scan's ranges to points in the frame of the laser.

Source: src/laser_geometry/laser_geometry.py of laser_geometry 2.8 (Jazzy),
https://github.com/ros-perception/laser_geometry
"""

from __future__ import annotations

import numpy as np
from sensor_msgs.msg import LaserScan, PointCloud2, PointField

from gz_course.sim.ros.sensor_msgs_py.point_cloud2 import create_cloud, dtype_from_fields


class LaserProjection:
    """A projection that remembers the directions of the rays from one scan to the next."""

    LASER_SCAN_INVALID = -1.0
    LASER_SCAN_MIN_RANGE = -2.0
    LASER_SCAN_MAX_RANGE = -3.0

    class ChannelOption:
        """Flags for fields of the cloud beside x, y and z; they can be combined with `|`.

        The fields are `intensity`, `index` (of the ray), `distances` [m], `stamps` [s] after the first ray, and
        `vp_x`, `vp_y`, `vp_z` [m], which are 0.
        """

        NONE = 0x00
        INTENSITY = 0x01
        INDEX = 0x02
        DISTANCE = 0x04
        TIMESTAMP = 0x08
        VIEWPOINT = 0x10
        DEFAULT = INTENSITY | INDEX

    def __init__(self) -> None:
        self._scan = (0.0, 0.0, 0)
        self._directions = np.empty((2, 0))

    def projectLaser(
        self, scan_in: LaserScan, range_cutoff: float = -1.0, channel_options: int = ChannelOption.DEFAULT
    ) -> PointCloud2:
        """Return a cloud of the ranges from `range_min` to below `range_max`, or below `range_cutoff` [m] if smaller.

        A `range_cutoff` below 0 is ignored. Other ranges have no point. Raises IndexError if the scan has fewer
        intensities than ranges, but any.
        """
        ranges = np.array(scan_in.ranges, dtype=np.float64)
        cutoff = scan_in.range_max if range_cutoff < 0 else min(range_cutoff, scan_in.range_max)
        kept = np.flatnonzero((ranges < cutoff) & (ranges >= scan_in.range_min))
        ranges = ranges[kept]
        x, y = self._rays(scan_in)[:, kept] * ranges
        columns: dict[str, np.ndarray | float] = {"x": x, "y": y, "z": 0.0}
        options = self.ChannelOption
        if channel_options & options.INTENSITY and len(scan_in.intensities) > 0:
            columns["intensity"] = np.array(scan_in.intensities)[kept]
        if channel_options & options.INDEX:
            columns["index"] = kept
        if channel_options & options.DISTANCE:
            columns["distances"] = ranges
        if channel_options & options.TIMESTAMP:
            columns["stamps"] = kept * scan_in.time_increment
        if channel_options & options.VIEWPOINT:
            columns |= {"vp_x": 0.0, "vp_y": 0.0, "vp_z": 0.0}
        fields = [
            PointField(
                name=name,
                offset=4 * number,
                datatype=PointField.INT32 if name == "index" else PointField.FLOAT32,
                count=1,
            )
            for number, name in enumerate(columns)
        ]
        points: np.ndarray = np.empty(len(kept), dtype_from_fields(fields))
        for name, values in columns.items():
            points[name] = values
        return create_cloud(scan_in.header, fields, points)

    def _rays(self, scan: LaserScan) -> np.ndarray:
        """Return the directions of the rays as (2, n)."""
        key = (scan.angle_min, scan.angle_increment, len(scan.ranges))
        if self._scan != key:
            angles = scan.angle_min + np.arange(len(scan.ranges)) * scan.angle_increment
            self._directions = np.array([np.cos(angles), np.sin(angles)])
            self._scan = key
        return self._directions
