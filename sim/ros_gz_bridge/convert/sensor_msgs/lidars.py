"""LaserScan, Range and PointCloud2. Ranges and points are copied in one piece, never one by one."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from sensor_msgs.msg import LaserScan, PointCloud2, PointField, Range

from gz_course.sim.gz.msgs.laserscan_pb2 import LaserScan as GzLaserScan
from gz_course.sim.gz.msgs.pointcloud_packed_pb2 import PointCloudPacked
from gz_course.sim.ros_gz_bridge.blank import blank
from gz_course.sim.ros_gz_bridge.header import fill_header, fill_stamp, frame_to_ros, header_to_gz
from gz_course.sim.ros_gz_bridge.type_pairs import ConversionError, type_pair


@type_pair("sensor_msgs/msg/LaserScan", "gz.msgs.LaserScan")
class LaserScanPair:
    """Ranges in metres by angle in radians; no return is infinite on both sides.

    A Gazebo scan may have several layers, one above the other, where ROS has one: the middle layer is taken.
    Its frame comes from the field ``frame``, not from the header. Times between beams are unknown, so they
    are 0.
    """

    @staticmethod
    def to_ros(gz: Any) -> LaserScan:
        """Gazebo to ROS."""
        ranges, intensities, count = gz.ranges, gz.intensities, gz.count
        start = (gz.vertical_count // 2) * count
        end = start + count
        if len(ranges) < end:
            raise ConversionError(f"the scan announces {count} beams a layer but carries {len(ranges)} ranges")
        ros = blank(LaserScan)
        _fill_header(gz, ros.header)
        ros.angle_min = gz.angle_min
        ros.angle_max = gz.angle_max
        ros.angle_increment = gz.angle_step
        ros.range_min = gz.range_min
        ros.range_max = gz.range_max
        with np.errstate(over="ignore"):  # beyond float32 is infinite, as in C
            ros.ranges.frombytes(np.asarray(ranges, dtype=np.float32)[start:end].tobytes())
            if len(intensities) >= end:
                ros.intensities.frombytes(np.asarray(intensities, dtype=np.float32)[start:end].tobytes())
        return ros

    @staticmethod
    def to_gz(ros: LaserScan) -> Any:
        """ROS to Gazebo."""
        gz = GzLaserScan(
            frame=ros.header.frame_id,
            angle_min=ros.angle_min,
            angle_max=ros.angle_max,
            angle_step=ros.angle_increment,
            range_min=ros.range_min,
            range_max=ros.range_max,
            count=len(ros.ranges),
            ranges=ros.ranges,
            intensities=ros.intensities,
        )
        header_to_gz(ros.header, gz.header)
        return gz


def _fill_header(gz: Any, header: Any) -> None:
    fill_stamp(gz.header.stamp, header.stamp)
    header.frame_id = frame_to_ros(gz.frame)


@type_pair("sensor_msgs/msg/Range", "gz.msgs.LaserScan")
class RangePair:
    """The single beam of a lidar as a distance; of several beams the nearest, as a real range finder answers."""

    @staticmethod
    def to_ros(gz: Any) -> Range:
        """Gazebo to ROS."""
        ros = Range(
            radiation_type=Range.INFRARED,
            field_of_view=gz.angle_max - gz.angle_min,
            min_range=gz.range_min,
            max_range=gz.range_max,
            range=min((number for number in gz.ranges if not math.isnan(number)), default=math.nan),
        )
        _fill_header(gz, ros.header)
        return ros

    @staticmethod
    def to_gz(ros: Range) -> Any:
        """ROS to Gazebo: one beam, straight ahead in the middle of the field of view."""
        gz = GzLaserScan(
            frame=ros.header.frame_id,
            angle_min=-ros.field_of_view / 2,
            angle_max=ros.field_of_view / 2,
            angle_step=ros.field_of_view,
            range_min=ros.min_range,
            range_max=ros.max_range,
            count=1,
            ranges=[ros.range],
        )
        header_to_gz(ros.header, gz.header)
        return gz


@type_pair("sensor_msgs/msg/PointCloud2", "gz.msgs.PointCloudPacked")
class PointCloud2Pair:
    """Points as bytes, with the fields that say how to read them."""

    @staticmethod
    def to_ros(gz: Any) -> PointCloud2:
        """Gazebo to ROS."""
        ros = PointCloud2(
            height=gz.height,
            width=gz.width,
            fields=[
                # Gazebo counts the types of numbers from 0, ROS from 1.
                PointField(name=field.name, offset=field.offset, datatype=field.datatype + 1, count=field.count)
                for field in gz.field
                if _check_type(field.name, field.datatype + 1)
            ],
            is_bigendian=gz.is_bigendian,
            point_step=gz.point_step,
            row_step=gz.row_step,
            is_dense=gz.is_dense,
        )
        fill_header(gz.header, ros.header)
        ros.data.frombytes(gz.data)  # handed to the constructor, the bytes would be copied three times
        return ros

    @staticmethod
    def to_gz(ros: PointCloud2) -> Any:
        """ROS to Gazebo."""
        gz = PointCloudPacked(
            height=ros.height,
            width=ros.width,
            is_bigendian=ros.is_bigendian,
            point_step=ros.point_step,
            row_step=ros.row_step,
            data=bytes(ros.data),
            is_dense=ros.is_dense,
        )
        header_to_gz(ros.header, gz.header)
        for field in ros.fields:
            _check_type(field.name, field.datatype)
            gz.field.add(name=field.name, offset=field.offset, datatype=field.datatype - 1, count=field.count)
        return gz


def _check_type(field: str, datatype: int) -> bool:
    if not PointField.INT8 <= datatype <= PointField.FLOAT64:
        raise ConversionError(
            f"the field {field!r} of the points is of the unknown type number {datatype} (ROS: 1 to 8)"
        )
    return True
