"""`TransformBroadcaster`: publishes transforms that change, on `/tf`.

Source: tf2_ros_py/tf2_ros/transform_broadcaster.py of https://github.com/ros2/geometry2
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from geometry_msgs.msg import TransformStamped
from rclpy.qos import QoSProfile
from tf2_msgs.msg import TFMessage

if TYPE_CHECKING:
    from rclpy.node import Node

_QOS = QoSProfile(depth=100)


class TransformBroadcaster:
    """A publisher of a node on `/tf`."""

    def __init__(self, node: Node, qos: QoSProfile | int = _QOS) -> None:
        self.pub_tf = node.create_publisher(TFMessage, "/tf", qos)

    def sendTransform(self, transform: TransformStamped | Iterable[TransformStamped]) -> None:
        """Publish a transform, or several in one message."""
        self.pub_tf.publish(message_of(transform))


def message_of(transform: TransformStamped | Iterable[TransformStamped]) -> TFMessage:
    """Return the message with a transform, or with several."""
    return TFMessage(transforms=list(transform) if isinstance(transform, Iterable) else [transform])
