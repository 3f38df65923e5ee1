"""`BufferCore`, the tree of coordinate frames over time, in place of the `tf2_py` package; in plain Python.

Source: tf2_py/src/tf2_py.cpp of https://github.com/ros2/geometry2
"""

from gz_course.sim.ros.tf2_py.buffer_core import BufferCore
from gz_course.sim.ros.tf2_py.exceptions import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
)

__all__ = [
    "BufferCore",
    "ConnectivityException",
    "ExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "TimeoutException",
    "TransformException",
]
