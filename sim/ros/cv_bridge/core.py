"""The class CvBridge: ROS image messages to NumPy arrays and back.

Source: cv_bridge/python/cv_bridge/core.py of vision_opencv 4.1 (Jazzy), the texts of its exceptions included
"""

from __future__ import annotations

import sys
from typing import Any, cast

import numpy as np
from sensor_msgs.msg import CompressedImage, Image

from gz_course.sim.ros.cv_bridge import picture_file
from gz_course.sim.ros.cv_bridge.color import convert
from gz_course.sim.ros.cv_bridge.encodings import DEPTHS, NUMPY_NAMES, channels_of, cv_type, depth_of, make_type

_ARRAYS = (np.ndarray, np.generic)
_BIG = sys.byteorder == "big"
_NAMES = {np.dtype(name): name for name in NUMPY_NAMES}  # NumPy makes the name of a type anew each time


class CvBridgeError(TypeError):
    """A conversion that is not possible."""


class CvBridge:
    """A converter between ROS images and arrays of shape (height, width) or (height, width, channels).

    `cvtype_to_name` maps OpenCV's numbers of types to names such as `8UC3`; `cvdepth_to_numpy_depth` and
    `numpy_type_to_cvtype` map the types of values.
    """

    def __init__(self) -> None:
        self.cvtype_to_name = {make_type(depth, n): f"{depth}C{n}" for depth in DEPTHS for n in (1, 2, 3, 4)}
        self.cvdepth_to_numpy_depth = dict(enumerate(NUMPY_NAMES))
        self.numpy_type_to_cvtype = dict(zip(NUMPY_NAMES, DEPTHS, strict=True))
        self.numpy_type_to_cvtype |= dict(zip(DEPTHS, NUMPY_NAMES, strict=True))

    def dtype_with_channels_to_cvtype2(self, dtype: np.dtype, n_channels: int) -> str:
        """Return the name of a type, such as `8UC3`. Raises KeyError for a type that OpenCV does not have."""
        name = _NAMES.get(dtype) or dtype.name
        return f"{self.numpy_type_to_cvtype[name]}C{n_channels}"

    def cvtype2_to_dtype_with_channels(self, cvtype: int) -> tuple[str, int]:
        """Return the NumPy type and the number of channels of OpenCV's number of a type."""
        return self.cvdepth_to_numpy_depth[depth_of(cvtype)], channels_of(cvtype)

    def encoding_to_cvtype2(self, encoding: str) -> int:
        """Return OpenCV's number of the type of an encoding. Raises CvBridgeError for an unknown one."""
        try:
            return cv_type(encoding)
        except RuntimeError as error:
            raise CvBridgeError(error) from None

    def encoding_to_dtype_with_channels(self, encoding: str) -> tuple[str, int]:
        """Return the NumPy type and the number of channels of an encoding. Raises CvBridgeError for an unknown one."""
        return self.cvtype2_to_dtype_with_channels(self.encoding_to_cvtype2(encoding))

    def imgmsg_to_cv2(self, img_msg: Image, desired_encoding: str = "passthrough") -> np.ndarray:
        """Return the image as an array, in its own encoding (`passthrough`) or another one.

        In its own encoding the array shares the memory of the message, unless rows are padded or the byte order is not
        that of the machine. Raises CvBridgeError if there is no such conversion, and TypeError for a message with less
        data than it says.
        """
        name, channels = self.encoding_to_dtype_with_channels(img_msg.encoding)
        dtype = np.dtype(name).newbyteorder(">" if img_msg.is_bigendian else "<")
        columns = img_msg.step // (dtype.itemsize * channels)
        if img_msg.height * img_msg.step > memoryview(img_msg.data).nbytes:
            raise TypeError("buffer is too small for requested array")
        image: np.ndarray = np.ndarray(
            shape=(img_msg.height, min(img_msg.width, columns), channels),
            dtype=dtype,
            buffer=img_msg.data,
            strides=(img_msg.step, dtype.itemsize * channels, dtype.itemsize),
        )
        image = np.ascontiguousarray(image[:, :, 0] if channels == 1 else image, dtype=dtype.newbyteorder("="))
        return self._converted(image, img_msg.encoding, desired_encoding)

    def cv2_to_imgmsg(self, cvim: np.ndarray, encoding: str = "passthrough", header: Any = None) -> Image:
        """Return a message with the image; the values are not converted.

        `passthrough` names the encoding after the type (`8UC3`). Raises CvBridgeError if the image does not have the
        type of the encoding, TypeError for something that is no array, and KeyError for a type that OpenCV does not
        have.
        """
        if not isinstance(cvim, _ARRAYS):
            raise TypeError("Your input type is not a numpy array")
        message = Image()
        message.height, message.width = cvim.shape[0], cvim.shape[1]
        own_type = self.dtype_with_channels_to_cvtype2(cvim.dtype, 1 if cvim.ndim < 3 else cvim.shape[2])
        if encoding == "passthrough":
            message.encoding = own_type
        else:
            message.encoding = encoding
            if self.cvtype_to_name[self.encoding_to_cvtype2(encoding)] != own_type:
                raise CvBridgeError(f"encoding specified as {encoding}, but image has incompatible type {own_type}")
        message.is_bigendian = int(cvim.dtype.byteorder == ">" or (cvim.dtype.byteorder == "=" and _BIG))
        values = memoryview(cast(Any, np.ascontiguousarray(cvim))).cast("B")
        message.data.frombytes(values)  # assigned data would be copied once more
        message.step = len(message.data) // message.height
        if header is not None:
            message.header = header
        return message

    def compressed_imgmsg_to_cv2(self, cmprs_img_msg: CompressedImage, desired_encoding: str = "passthrough") -> Any:
        """Return a compressed picture as an array, with `passthrough` gray or BGR, or else in another encoding.

        The result is None if the data cannot be read as a picture and no conversion is wanted. Raises CvBridgeError if
        there is no such conversion.
        """
        image = picture_file.decoded(bytes(cmprs_img_msg.data))
        if image is None and desired_encoding != "passthrough":
            raise CvBridgeError(f"the data is no picture that can be read (format '{cmprs_img_msg.format[:60]}')")
        return image if image is None else self._converted(image, "bgr8", desired_encoding)

    def cv2_to_compressed_imgmsg(self, cvim: np.ndarray, dst_format: str = "jpg") -> CompressedImage:
        """Return a message with a picture: gray, BGR or BGRA, as `jpg`, `png`, `bmp`, `tiff` and so on.

        Raises TypeError for something that is no array, and CvBridgeError for a format or a type that cannot be
        written.
        """
        if not isinstance(cvim, _ARRAYS):
            raise TypeError("Your input type is not a numpy array")
        message = CompressedImage()
        message.format = dst_format
        try:
            content = picture_file.encoded(np.asarray(cvim), dst_format)
        except RuntimeError as error:
            raise CvBridgeError(error) from None
        message.data.frombytes(content)
        return message

    def _converted(self, image: np.ndarray, encoding: str, desired: str) -> np.ndarray:
        if desired == "passthrough":
            return image
        try:
            return convert(image, encoding, desired)
        except RuntimeError as error:
            raise CvBridgeError(error) from None
