"""Transforms between ROS nodes, in place of the `tf2_ros` package: buffer, listener and broadcasters.

The programs of `ros2 run tf2_ros` are the modules `tf2_echo`, `tf2_monitor`, `static_transform_publisher` and
`view_frames`. There the package's names are all those of its modules, so the messages and classes of rclpy that these
import are here, too: the tutorials of ROS 2 write `from tf2_ros import TransformBroadcaster, TransformStamped`.

Source: tf2_ros_py of https://github.com/ros2/geometry2
"""

from geometry_msgs.msg import PointStamped, PoseStamped, PoseWithCovarianceStamped, TransformStamped, Vector3Stamped
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from rclpy.time import Time
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

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
    "DurabilityPolicy",
    "Duration",
    "ExtrapolationException",
    "Header",
    "HistoryPolicy",
    "InvalidArgumentException",
    "LookupException",
    "Node",
    "NotImplementedException",
    "PointStamped",
    "PoseStamped",
    "PoseWithCovarianceStamped",
    "QoSProfile",
    "Stamped",
    "StaticTransformBroadcaster",
    "TFMessage",
    "Time",
    "TimeoutException",
    "TransformBroadcaster",
    "TransformException",
    "TransformListener",
    "TransformRegistration",
    "TransformStamped",
    "TypeException",
    "Vector3Stamped",
    "convert",
]
