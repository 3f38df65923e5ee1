"""Image and CameraInfo. Pixels are copied in one piece, never one by one."""

from __future__ import annotations

from array import array
from typing import Any

import numpy as np
from sensor_msgs.msg import CameraInfo, Image

from gz_course.sim.gz.msgs.camera_info_pb2 import CameraInfo as GzCameraInfo
from gz_course.sim.gz.msgs.image_pb2 import Image as GzImage
from gz_course.sim.gz.msgs.image_pb2 import PixelFormatType
from gz_course.sim.ros_gz_bridge.header import fill_header, header_to_gz
from gz_course.sim.ros_gz_bridge.type_pairs import ConversionError, type_pair

# ROS encoding -> (Gazebo pixel format, bytes of one pixel).
ENCODINGS = {
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
_WIDE = ("mono16", "rgb16", "bgr16", "32FC1")
_FORMATS = {PixelFormatType.Value(name): encoding for encoding, (name, _) in ENCODINGS.items()}


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
            raise ConversionError(f"the pixel format {name} has no ROS encoding (known: {', '.join(ENCODINGS)})")
        step = gz.step or gz.width * ENCODINGS[encoding][1]
        data = gz.data  # every access makes a copy
        _check_pixels(gz.width, gz.height, step, len(data), encoding)
        ros = Image(
            height=gz.height,
            width=gz.width,
            encoding=encoding,
            is_bigendian=0,
            step=step,
        )
        fill_header(gz.header, ros.header)
        ros.data.frombytes(data)  # handed to the constructor, the bytes would be copied three times
        return ros

    @staticmethod
    def to_gz(ros: Image) -> Any:
        """ROS to Gazebo."""
        if ros.encoding not in ENCODINGS:
            raise ConversionError(
                f"the encoding {ros.encoding!r} has no Gazebo pixel format (known: {', '.join(ENCODINGS)})"
            )
        if ros.is_bigendian and ros.encoding in _WIDE:
            raise ConversionError(f"the numbers of a {ros.encoding} image are big-endian; Gazebo's are little-endian")
        _check_pixels(ros.width, ros.height, ros.step, len(ros.data), ros.encoding)
        gz = GzImage(
            width=ros.width,
            height=ros.height,
            step=ros.step,
            data=bytes(ros.data),
            pixel_format_type=ENCODINGS[ros.encoding][0],
        )
        header_to_gz(ros.header, gz.header)
        return gz


def _check_pixels(width: int, height: int, step: int, size: int, encoding: str) -> None:
    row = width * ENCODINGS[encoding][1]
    if step < row or size != step * height:
        raise ConversionError(
            f"an image of {width}x{height} {encoding} pixels with rows of {step} bytes must carry "
            f"{max(step, row) * height} bytes, not {size}"
        )


# ROS distortion model -> Gazebo's.
_MODELS = {
    "plumb_bob": GzCameraInfo.Distortion.PLUMB_BOB,
    "rational_polynomial": GzCameraInfo.Distortion.RATIONAL_POLYNOMIAL,
    "equidistant": GzCameraInfo.Distortion.EQUIDISTANT,
}
_MODEL_NAMES = {number: name for name, number in _MODELS.items()}


@type_pair("sensor_msgs/msg/CameraInfo", "gz.msgs.CameraInfo")
class CameraInfoPair:
    """Size, distortion, and the matrices K (3x3), R (3x3) and P (3x4), row by row; binning and region stay unset.

    A matrix Gazebo does not give is zero, which in ROS means an uncalibrated camera.
    """

    @staticmethod
    def to_ros(gz: Any) -> CameraInfo:
        """Gazebo to ROS."""
        ros = CameraInfo(width=gz.width, height=gz.height)
        fill_header(gz.header, ros.header)
        if gz.HasField("distortion"):
            model = gz.distortion.model
            if model not in _MODEL_NAMES:
                raise ConversionError(f"the distortion model number {model} is unknown (known: {', '.join(_MODELS)})")
            ros.distortion_model = _MODEL_NAMES[model]
            ros.d = array("d", gz.distortion.k)
        ros.k = _matrix("K", gz.intrinsics.k, 9)
        ros.r = _matrix("R", gz.rectification_matrix, 9)
        ros.p = _matrix("P", gz.projection.p, 12)
        return ros

    @staticmethod
    def to_gz(ros: CameraInfo) -> Any:
        """ROS to Gazebo."""
        gz = GzCameraInfo(width=ros.width, height=ros.height, rectification_matrix=ros.r)
        header_to_gz(ros.header, gz.header)
        if ros.distortion_model or len(ros.d):
            if ros.distortion_model not in _MODELS:
                raise ConversionError(
                    f"the distortion model {ros.distortion_model!r} is not Gazebo's (known: {', '.join(_MODELS)})"
                )
            gz.distortion.model = _MODELS[ros.distortion_model]
            gz.distortion.k.extend(ros.d)
        gz.intrinsics.k.extend(ros.k)
        gz.projection.p.extend(ros.p)
        return gz


def _matrix(name: str, numbers: Any, size: int) -> Any:
    if len(numbers) not in (0, size):
        raise ConversionError(f"the matrix {name} of a camera has {size} numbers, not {len(numbers)}")
    return np.array(numbers, dtype=np.float64) if len(numbers) else np.zeros(size)
