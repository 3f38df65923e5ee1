"""Transforms between ROS nodes, in place of the `tf2_ros` package: buffer, listener and broadcasters.

The programs of `ros2 run tf2_ros` are the modules `tf2_echo`, `tf2_monitor`, `static_transform_publisher` and
`view_frames`.

Source: tf2_ros_py of https://github.com/ros2/geometry2
"""

from gz_course.sim.ros.tf2_py import (
    BufferCore,
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
)
from gz_course.sim.ros.tf2_ros.buffer import Buffer
from gz_course.sim.ros.tf2_ros.buffer_interface import (
    BufferInterface,
    ConvertRegistration,
    NotImplementedException,
    Stamped,
    TransformRegistration,
    TypeException,
    convert,
)
from gz_course.sim.ros.tf2_ros.static_transform_broadcaster import StaticTransformBroadcaster
from gz_course.sim.ros.tf2_ros.transform_broadcaster import TransformBroadcaster
from gz_course.sim.ros.tf2_ros.transform_listener import TransformListener

__all__ = [
    "Buffer",
    "BufferCore",
    "BufferInterface",
    "ConnectivityException",
    "ConvertRegistration",
    "ExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "NotImplementedException",
    "Stamped",
    "StaticTransformBroadcaster",
    "TimeoutException",
    "TransformBroadcaster",
    "TransformException",
    "TransformListener",
    "TransformRegistration",
    "TypeException",
    "convert",
]
