"""sensor_msgs: LaserScan, Imu and Image."""

from __future__ import annotations

from array import array
from typing import Any

from gz.msgs.image_pb2 import Image as GzImage
from gz.msgs.image_pb2 import PixelFormatType
from gz.msgs.imu_pb2 import IMU
from gz.msgs.laserscan_pb2 import LaserScan as GzLaserScan
from sensor_msgs.msg import Image, Imu, LaserScan

from ros_gz_bridge.convert.geometry_msgs import copy_xyz, copy_xyzw, quaternion_to_ros, vector_to_ros
from ros_gz_bridge.header import frame_to_ros, header_to_gz, header_to_ros
from ros_gz_bridge.type_pairs import ConversionError, type_pair

# ROS encoding -> (Gazebo pixel format, bytes of one pixel).
_ENCODINGS = {
    "mono8": ("L_INT8", 1),
    "mono16": ("L_INT16", 2),
    "rgb8": ("RGB_INT8", 3),
    "rgba8": ("RGBA_INT8", 4),
    "bgra8": ("BGRA_INT8", 4),
    "rgb16": ("RGB_INT16", 6),
    "bgr8": ("BGR_INT8", 3),
    "bgr16": ("BGR_INT16", 6),
    "32FC1": ("R_FLOAT32", 4),
}
_FORMATS = {PixelFormatType.Value(name): encoding for encoding, (name, _) in _ENCODINGS.items()}


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
        start = (gz.vertical_count // 2) * gz.count
        header = header_to_ros(gz.header)
        header.frame_id = frame_to_ros(gz.frame)
        ros = LaserScan(
            header=header,
            angle_min=gz.angle_min,
            angle_max=gz.angle_max,
            angle_increment=gz.angle_step,
            range_min=gz.range_min,
            range_max=gz.range_max,
        )
        if len(gz.ranges) < start + gz.count:
            raise ConversionError(f"the scan announces {gz.count} beams a layer but carries {len(gz.ranges)} ranges")
        # Assigning an array is many times faster than a list, whose every element ROS checks in Python.
        ros.ranges = array("f", gz.ranges[start : start + gz.count])
        if len(gz.intensities) >= start + gz.count:
            ros.intensities = array("f", gz.intensities[start : start + gz.count])
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


@type_pair("sensor_msgs/msg/Imu", "gz.msgs.IMU")
class ImuPair:
    """Orientation, angular velocity (rad/s) and linear acceleration (m/s², with gravity); covariances."""

    @staticmethod
    def to_ros(gz: Any) -> Imu:
        """Gazebo to ROS."""
        ros = Imu(
            header=header_to_ros(gz.header),
            orientation=quaternion_to_ros(gz.orientation),
            angular_velocity=vector_to_ros(gz.angular_velocity),
            linear_acceleration=vector_to_ros(gz.linear_acceleration),
        )
        for field in (
            "orientation_covariance",
            "angular_velocity_covariance",
            "linear_acceleration_covariance",
        ):
            numbers = getattr(gz, field).data
            if len(numbers) == 9:
                setattr(ros, field, list(numbers))
        return ros

    @staticmethod
    def to_gz(ros: Imu) -> Any:
        """ROS to Gazebo; the frame is the entity's name too."""
        gz = IMU(entity_name=ros.header.frame_id)
        header_to_gz(ros.header, gz.header)
        copy_xyzw(ros.orientation, gz.orientation)
        copy_xyz(ros.angular_velocity, gz.angular_velocity)
        copy_xyz(ros.linear_acceleration, gz.linear_acceleration)
        gz.orientation_covariance.data.extend(ros.orientation_covariance)
        gz.angular_velocity_covariance.data.extend(ros.angular_velocity_covariance)
        gz.linear_acceleration_covariance.data.extend(ros.linear_acceleration_covariance)
        return gz


@type_pair("sensor_msgs/msg/Image", "gz.msgs.Image")
class ImagePair:
    """Pixels, row by row; a depth image is ``32FC1`` in metres. Rows keep the padding they came with."""

    @staticmethod
    def to_ros(gz: Any) -> Image:
        """Gazebo to ROS."""
        encoding = _FORMATS.get(gz.pixel_format_type)
        if encoding is None:
            number = gz.pixel_format_type
            name = PixelFormatType.Name(number) if number in PixelFormatType.values() else f"number {number}"
            raise ConversionError(f"the pixel format {name} has no ROS encoding (known: {', '.join(_ENCODINGS)})")
        step = gz.step or gz.width * _ENCODINGS[encoding][1]
        _check_pixels(gz.width, gz.height, step, len(gz.data), encoding)
        return Image(
            header=header_to_ros(gz.header),
            height=gz.height,
            width=gz.width,
            encoding=encoding,
            is_bigendian=0,
            step=step,
            data=array("B", gz.data),
        )

    @staticmethod
    def to_gz(ros: Image) -> Any:
        """ROS to Gazebo."""
        if ros.encoding not in _ENCODINGS:
            raise ConversionError(
                f"the encoding {ros.encoding!r} has no Gazebo pixel format (known: {', '.join(_ENCODINGS)})"
            )
        _check_pixels(ros.width, ros.height, ros.step, len(ros.data), ros.encoding)
        gz = GzImage(
            width=ros.width,
            height=ros.height,
            step=ros.step,
            data=bytes(ros.data),
            pixel_format_type=_ENCODINGS[ros.encoding][0],
        )
        header_to_gz(ros.header, gz.header)
        return gz


def _check_pixels(width: int, height: int, step: int, size: int, encoding: str) -> None:
    row = width * _ENCODINGS[encoding][1]
    if step < row or size != step * height:
        raise ConversionError(
            f"an image of {width}x{height} {encoding} pixels with rows of {step} bytes must carry "
            f"{max(step, row) * height} bytes, not {size}"
        )
