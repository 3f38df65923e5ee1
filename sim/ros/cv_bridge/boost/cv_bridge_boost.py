"""The functions of cv_bridge's C++ library; their errors are RuntimeErrors.

Source: cv_bridge/src/module.cpp of vision_opencv 4.1
"""

from __future__ import annotations

import numpy as np

from gz_course.sim.ros.cv_bridge.color import convert
from gz_course.sim.ros.cv_bridge.encodings import channels_of, cv_type, depth_of


def getCvType(encoding: str) -> int:
    """Return OpenCV's number of the type that an encoding has, such as 16 (`CV_8UC3`) for `bgr8`."""
    return cv_type(encoding)


def cvtColor2(image: np.ndarray, encoding_in: str, encoding_out: str) -> np.ndarray:
    """Return a new image, converted from one encoding to another."""
    return convert(image, encoding_in, encoding_out)


def CV_MAT_CNWrap(number: int) -> int:
    """Return the number of channels of a type."""
    return channels_of(number)


def CV_MAT_DEPTHWrap(number: int) -> int:
    """Return the number of the depth of a type, such as 0 for `CV_8U`."""
    return depth_of(number)
