"""Image and CameraInfo. Pixels are copied in one piece.

Source: sensor_msgs/msg/CameraInfo.msg and sensor_msgs/image_encodings.hpp; gz/msgs/image.proto (PixelFormatType)
"""

from __future__ import annotations

from array import array
from typing import Any

import numpy as np
from sensor_msgs.msg import CameraInfo, Image

from gz_course.sim.bridge.ros_gz_bridge.fields import Part, message_pair
from gz_course.sim.bridge.ros_gz_bridge.header import copy_header, fill_header
from gz_course.sim.bridge.ros_gz_bridge.remarks import remark
from gz_course.sim.bridge.ros_gz_bridge.type_pairs import ConversionError
from gz_course.sim.gz.msgs.camera_info_pb2 import CameraInfo as GzCameraInfo
from gz_course.sim.gz.msgs.image_pb2 import PixelFormatType

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
"""For each ROS encoding the Gazebo pixel format and the size of a pixel [byte]; `32FC1` is a depth [m]."""
_WIDE = ("mono16", "rgb16", "bgr16", "32FC1")
_FORMATS = {PixelFormatType.Value(name): encoding for encoding, (name, _) in ENCODINGS.items()}
_MODELS = {
    "plumb_bob": GzCameraInfo.Distortion.PLUMB_BOB,
    "rational_polynomial": GzCameraInfo.Distortion.RATIONAL_POLYNOMIAL,
    "equidistant": GzCameraInfo.Distortion.EQUIDISTANT,
}
_MODEL_NAMES = {number: name for name, number in _MODELS.items()}


def _fill_image(gz: Any, ros: Image) -> None:
    """Write pixels row by row; rows keep their padding. An image of another format has no pixels in ROS."""
    encoding = _FORMATS.get(gz.pixel_format_type)
    if encoding is None:
        number = gz.pixel_format_type
        name = PixelFormatType.Name(number) if number in PixelFormatType.values() else f"number {number}"
        remark(f"the pixel format {name} has no ROS encoding (known: {', '.join(ENCODINGS)}), so the pixels are lost")
        fill_header(gz.header, ros.header)
        ros.height, ros.width = gz.height, gz.width
        return
    step = gz.step or gz.width * ENCODINGS[encoding][1]
    data = gz.data  # every access copies the bytes
    _check_pixels(gz.width, gz.height, step, len(data), encoding)
    fill_header(gz.header, ros.header)
    ros.height, ros.width, ros.step = gz.height, gz.width, step
    ros.encoding = encoding
    ros.data.frombytes(data)  # an assignment would copy the bytes three times


def _copy_image(ros: Image, gz: Any) -> None:
    if ros.encoding not in ENCODINGS:
        known = ", ".join(ENCODINGS)
        remark(f"the encoding {ros.encoding!r} has no Gazebo pixel format (known: {known}), so the pixels are lost")
        copy_header(ros.header, gz.header)
        gz.width, gz.height = ros.width, ros.height
        return
    if ros.is_bigendian and ros.encoding in _WIDE:
        raise ConversionError(f"the numbers of a {ros.encoding} image are big-endian; Gazebo's are little-endian")
    _check_pixels(ros.width, ros.height, ros.step, len(ros.data), ros.encoding)
    copy_header(ros.header, gz.header)
    gz.width, gz.height, gz.step = ros.width, ros.height, ros.step
    gz.data = bytes(ros.data)
    gz.pixel_format_type = PixelFormatType.Value(ENCODINGS[ros.encoding][0])


def _check_pixels(width: int, height: int, step: int, size: int, encoding: str) -> None:
    row = width * ENCODINGS[encoding][1]
    if step < row or size != step * height:
        raise ConversionError(
            f"an image of {width}x{height} {encoding} pixels with rows of {step} bytes must carry "
            f"{max(step, row) * height} bytes, not {size}"
        )


def _fill_info(gz: Any, ros: CameraInfo) -> None:
    """Write size, distortion, and the row-major matrices K (3, 3), R (3, 3) and P (3, 4).

    A matrix that Gazebo leaves out is zero, which in ROS means an uncalibrated camera. Binning and region stay unset.
    A distortion of another model keeps its coefficients without its name.
    """
    fill_header(gz.header, ros.header)
    ros.width, ros.height = gz.width, gz.height
    if gz.HasField("distortion"):
        model = gz.distortion.model
        if model in _MODEL_NAMES:
            ros.distortion_model = _MODEL_NAMES[model]
        else:
            remark(f"the distortion model number {model} is unknown (known: {', '.join(_MODELS)}), so it has no name")
        ros.d = array("d", gz.distortion.k)
    ros.k = _matrix("K", gz.intrinsics.k, 9)
    ros.r = _matrix("R", gz.rectification_matrix, 9)
    ros.p = _matrix("P", gz.projection.p, 12)


def _copy_info(ros: CameraInfo, gz: Any) -> None:
    copy_header(ros.header, gz.header)
    gz.width, gz.height = ros.width, ros.height
    gz.distortion.SetInParent()
    if ros.distortion_model in _MODELS:
        gz.distortion.model = _MODELS[ros.distortion_model]
    elif ros.distortion_model or len(ros.d):
        known = ", ".join(_MODELS)
        remark(f"the distortion model {ros.distortion_model!r} is not Gazebo's (known: {known}); plumb_bob was sent")
    gz.distortion.k.extend(ros.d)
    gz.intrinsics.k.extend(ros.k)
    gz.rectification_matrix.extend(ros.r)
    gz.projection.p.extend(ros.p)


def _matrix(name: str, numbers: Any, size: int) -> Any:
    if len(numbers) not in (0, size):
        raise ConversionError(f"the matrix {name} of a camera has {size} numbers, not {len(numbers)}")
    return np.array(numbers, dtype=np.float64) if len(numbers) else np.zeros(size)


message_pair("sensor_msgs/msg/Image", "gz.msgs.Image", Part(Image, _fill_image, _copy_image))
message_pair("sensor_msgs/msg/CameraInfo", "gz.msgs.CameraInfo", Part(CameraInfo, _fill_info, _copy_info))
