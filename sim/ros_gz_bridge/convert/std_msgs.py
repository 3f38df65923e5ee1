"""std_msgs: the scalars, String, Empty, Header and ColorRGBA."""

from __future__ import annotations

from typing import Any

from std_msgs.msg import ColorRGBA, Empty, Header

from gz_course.sim.gz.msgs.color_pb2 import Color
from gz_course.sim.gz.msgs.empty_pb2 import Empty as GzEmpty
from gz_course.sim.gz.msgs.header_pb2 import Header as GzHeader
from gz_course.sim.ros_gz_bridge.header import header_to_gz, header_to_ros
from gz_course.sim.ros_gz_bridge.type_pairs import add_pair, type_pair


def _data_pair(ros_type: str, gz_type: str) -> None:
    """Pair two messages that carry their value in one field ``data``."""
    import std_msgs.msg

    from gz_course.sim.gz.msgs import message_class

    ros_class = getattr(std_msgs.msg, ros_type.rpartition("/")[2])
    gz_class = message_class(gz_type)
    add_pair(
        ros_type,
        gz_type,
        to_ros=lambda gz: ros_class(data=gz.data),
        to_gz=lambda ros: gz_class(data=ros.data),
    )


_data_pair("std_msgs/msg/Bool", "gz.msgs.Boolean")
_data_pair("std_msgs/msg/Float32", "gz.msgs.Float")
_data_pair("std_msgs/msg/Float64", "gz.msgs.Double")
_data_pair("std_msgs/msg/Int32", "gz.msgs.Int32")
_data_pair("std_msgs/msg/UInt32", "gz.msgs.UInt32")
_data_pair("std_msgs/msg/String", "gz.msgs.StringMsg")


@type_pair("std_msgs/msg/Empty", "gz.msgs.Empty")
class EmptyPair:
    """Nothing but the fact that it was sent."""

    @staticmethod
    def to_ros(gz: Any) -> Empty:
        """Gazebo to ROS."""
        return Empty()

    @staticmethod
    def to_gz(ros: Empty) -> Any:
        """ROS to Gazebo."""
        return GzEmpty()


@type_pair("std_msgs/msg/Header", "gz.msgs.Header")
class HeaderPair:
    """Stamp and frame."""

    @staticmethod
    def to_ros(gz: Any) -> Header:
        """Gazebo to ROS."""
        return header_to_ros(gz)

    @staticmethod
    def to_gz(ros: Header) -> Any:
        """ROS to Gazebo."""
        gz = GzHeader()
        header_to_gz(ros, gz)
        return gz


@type_pair("std_msgs/msg/ColorRGBA", "gz.msgs.Color")
class ColorPair:
    """Red, green, blue and opacity, each 0 to 1."""

    @staticmethod
    def to_ros(gz: Any) -> ColorRGBA:
        """Gazebo to ROS."""
        return ColorRGBA(r=gz.r, g=gz.g, b=gz.b, a=gz.a)

    @staticmethod
    def to_gz(ros: ColorRGBA) -> Any:
        """ROS to Gazebo."""
        return Color(r=ros.r, g=ros.g, b=ros.b, a=ros.a)
