"""`StaticTransformBroadcaster`: publishes transforms that never change, on `/tf_static`.

Source: tf2_ros_py/tf2_ros/static_transform_broadcaster.py of https://github.com/ros2/geometry2
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from geometry_msgs.msg import TransformStamped
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from tf2_msgs.msg import TFMessage

from gz_course.sim.ros.tf2_ros.transform_broadcaster import message_of

if TYPE_CHECKING:
    from rclpy.node import Node


class StaticTransformBroadcaster:
    """A publisher of a node on `/tf_static`.

    Who comes later hears the last message only: all static transforms of a node belong into one `sendTransform`.
    """

    def __init__(self, node: Node, qos: QoSProfile | int | None = None) -> None:
        if qos is None:
            qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL, history=HistoryPolicy.KEEP_LAST)
        self.pub_tf = node.create_publisher(TFMessage, "/tf_static", qos)

    def sendTransform(self, transform: TransformStamped | Iterable[TransformStamped]) -> None:
        """Publish a transform, or several in one message."""
        self.pub_tf.publish(message_of(transform))
