"""LaserScan, Range and PointCloud2. Ranges and points are copied in one piece.

Source: ros_gz_bridge/src/convert/sensor_msgs.cpp; sensor_msgs/msg/PointField.msg; gz/msgs/pointcloud_packed.proto
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from sensor_msgs.msg import LaserScan, PointCloud2, PointField, Range

from gz_course.sim.bridge.ros_gz_bridge.fields import Part, message_pair
from gz_course.sim.bridge.ros_gz_bridge.header import copy_header, fill_header, fill_stamp, frame_to_ros
from gz_course.sim.bridge.ros_gz_bridge.remarks import remark
from gz_course.sim.bridge.ros_gz_bridge.type_pairs import ConversionError


def _fill_scan(gz: Any, ros: LaserScan) -> None:
    """Write the ranges [m] of the middle layer by angle [rad]; a ray without return is infinite on both sides.

    A Gazebo scan may have several layers, a ROS scan has one. The frame is in the field `frame` instead of the header.
    The times between rays are unknown and stay 0. The angle of the last ray is `angle_max`.
    """
    ranges, intensities, count = gz.ranges, gz.intensities, gz.count
    start = (gz.vertical_count // 2) * count
    end = start + count
    if len(ranges) < end:
        raise ConversionError(f"the scan announces {count} beams a layer but carries {len(ranges)} ranges")
    _fill_frame(gz, ros)
    ros.angle_min, ros.angle_max, ros.angle_increment = gz.angle_min, gz.angle_max, gz.angle_step
    ros.range_min, ros.range_max = gz.range_min, gz.range_max
    with np.errstate(over="ignore"):  # beyond float32 is infinite, as in C
        ros.ranges.frombytes(np.asarray(ranges, dtype=np.float32)[start:end].tobytes())
        if len(intensities) >= end:
            ros.intensities.frombytes(np.asarray(intensities, dtype=np.float32)[start:end].tobytes())


def _copy_scan(ros: LaserScan, gz: Any) -> None:
    """Write all rays; the original leaves out the last one, because it counts the steps between the rays."""
    _copy_frame(ros, gz)
    gz.angle_min, gz.angle_max, gz.angle_step = ros.angle_min, ros.angle_max, ros.angle_increment
    gz.range_min, gz.range_max, gz.count = ros.range_min, ros.range_max, len(ros.ranges)
    gz.ranges.extend(ros.ranges)
    gz.intensities.extend(ros.intensities)


def _fill_frame(gz: Any, ros: LaserScan | Range) -> None:
    fill_stamp(gz.header.stamp, ros.header.stamp)
    ros.header.frame_id = frame_to_ros(gz.frame)


def _copy_frame(ros: LaserScan | Range, gz: Any) -> None:
    copy_header(ros.header, gz.header)
    gz.frame = ros.header.frame_id


def _fill_range(gz: Any, ros: Range) -> None:
    """Write the smallest range [m] of all rays, like a real range finder."""
    _fill_frame(gz, ros)
    ros.radiation_type = Range.INFRARED
    ros.field_of_view = gz.angle_max - gz.angle_min
    ros.min_range, ros.max_range = gz.range_min, gz.range_max
    ros.range = min((number for number in gz.ranges if not math.isnan(number)), default=math.nan)


def _copy_range(ros: Range, gz: Any) -> None:
    """Write one ray in the middle of the field of view [rad]."""
    _copy_frame(ros, gz)
    gz.angle_min, gz.angle_max, gz.angle_step = -ros.field_of_view / 2, ros.field_of_view / 2, ros.field_of_view
    gz.range_min, gz.range_max, gz.count = ros.min_range, ros.max_range, 1
    gz.ranges.append(ros.range)


def _fill_cloud(gz: Any, ros: PointCloud2) -> None:
    """Write points as bytes, with the fields that describe them; Gazebo numbers types from 0, ROS from 1."""
    fill_header(gz.header, ros.header)
    for field in gz.field:
        datatype = _known_type(field.name, field.datatype + 1)
        ros.fields.append(PointField(name=field.name, offset=field.offset, datatype=datatype, count=field.count))
    ros.height, ros.width, ros.point_step, ros.row_step = gz.height, gz.width, gz.point_step, gz.row_step
    ros.is_bigendian, ros.is_dense = gz.is_bigendian, gz.is_dense
    ros.data.frombytes(gz.data)  # an assignment would copy the bytes three times


def _copy_cloud(ros: PointCloud2, gz: Any) -> None:
    copy_header(ros.header, gz.header)
    for field in ros.fields:
        datatype = _known_type(field.name, field.datatype) - 1
        gz.field.add(name=field.name, offset=field.offset, datatype=datatype, count=field.count)
    gz.height, gz.width, gz.point_step, gz.row_step = ros.height, ros.width, ros.point_step, ros.row_step
    gz.is_bigendian, gz.is_dense = ros.is_bigendian, ros.is_dense
    gz.data = bytes(ros.data)


def _known_type(field: str, datatype: int) -> int:
    """Return ROS's number of a type, INT8 for an unknown one."""
    if PointField.INT8 <= datatype <= PointField.FLOAT64:
        return datatype
    remark(f"the field {field!r} of the points is of the unknown type number {datatype} (ROS: 1 to 8); INT8 was sent")
    return int(PointField.INT8)


message_pair("sensor_msgs/msg/LaserScan", "gz.msgs.LaserScan", Part(LaserScan, _fill_scan, _copy_scan))
message_pair("sensor_msgs/msg/Range", "gz.msgs.LaserScan", Part(Range, _fill_range, _copy_range))
message_pair("sensor_msgs/msg/PointCloud2", "gz.msgs.PointCloudPacked", Part(PointCloud2, _fill_cloud, _copy_cloud))
