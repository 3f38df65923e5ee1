"""Twists and wrenches: how something moves and is moved. As commands they must be finite."""

from __future__ import annotations

import math
import operator
from typing import Any

from geometry_msgs.msg import (
    Quaternion,
    Twist,
    TwistStamped,
    TwistWithCovariance,
    TwistWithCovarianceStamped,
    Wrench,
    WrenchStamped,
)

from gz_course.sim.gz.msgs.twist_pb2 import Twist as GzTwist
from gz_course.sim.gz.msgs.twist_with_covariance_pb2 import TwistWithCovariance as GzTwistWithCovariance
from gz_course.sim.gz.msgs.wrench_pb2 import Wrench as GzWrench
from gz_course.sim.ros_gz_bridge.blank import blank
from gz_course.sim.ros_gz_bridge.convert.geometry_msgs.poses import VECTOR3, copy_xyz, covariance_to_ros, fill_xyz
from gz_course.sim.ros_gz_bridge.fields import Fields, Part, add_fields
from gz_course.sim.ros_gz_bridge.header import fill_header, header_to_gz, header_to_ros
from gz_course.sim.ros_gz_bridge.type_pairs import type_pair


def fill_twist(gz: Any, ros: Twist) -> None:
    """Write linear and angular velocity of a ``gz.msgs.Twist`` into a ROS twist."""
    fill_xyz(gz.linear, ros.linear)
    fill_xyz(gz.angular, ros.angular)


def twist_to_ros(gz: Any) -> Twist:
    """Linear and angular velocity of a ``gz.msgs.Twist``."""
    ros = blank(Twist)
    fill_twist(gz, ros)
    return ros


def copy_twist(ros: Twist, gz: Any) -> None:
    """Write a ROS twist into ``gz``."""
    copy_xyz(ros.linear, gz.linear)
    copy_xyz(ros.angular, gz.angular)


def not_finite(message: Any, *paths: str) -> str | None:
    """The numbers that are not finite (``"linear.x is nan"``), or None: no simulator survives them.

    Each path leads to a number of ``message`` or to a message whose numbers are ``x, y, z`` (and ``w``).
    """
    bad = []
    for path in paths:
        value = operator.attrgetter(path)(message)
        if isinstance(value, float):
            numbers = [(path, value)]
        else:
            axes = "xyzw" if isinstance(value, Quaternion) else "xyz"
            if math.isfinite(sum([getattr(value, axis) for axis in axes])):
                continue  # as almost always: a sum is finite only if all numbers are
            numbers = [(f"{path}.{axis}", getattr(value, axis)) for axis in axes]
        bad += [f"{name} is {number}" for name, number in numbers if not math.isfinite(number)]
    return ", ".join(bad) or None


@type_pair("geometry_msgs/msg/Twist", "gz.msgs.Twist")
class TwistPair:
    """Velocity of a body: linear and angular."""

    to_ros = staticmethod(twist_to_ros)

    @staticmethod
    def to_gz(ros: Twist) -> Any:
        """ROS to Gazebo."""
        gz = GzTwist()
        copy_twist(ros, gz)
        return gz

    @staticmethod
    def fault(ros: Twist) -> str | None:
        """What must not reach the simulator."""
        return not_finite(ros, "linear", "angular")


@type_pair("geometry_msgs/msg/TwistStamped", "gz.msgs.Twist")
class TwistStampedPair:
    """A twist with its header."""

    @staticmethod
    def to_ros(gz: Any) -> TwistStamped:
        """Gazebo to ROS."""
        ros = blank(TwistStamped)
        fill_header(gz.header, ros.header)
        fill_twist(gz, ros.twist)
        return ros

    @staticmethod
    def to_gz(ros: TwistStamped) -> Any:
        """ROS to Gazebo."""
        gz = GzTwist()
        header_to_gz(ros.header, gz.header)
        copy_twist(ros.twist, gz)
        return gz

    @staticmethod
    def fault(ros: TwistStamped) -> str | None:
        """What must not reach the simulator."""
        return not_finite(ros, "twist.linear", "twist.angular")


def fill_twist_with_covariance(gz: Any, ros: TwistWithCovariance) -> None:
    """Write a ``gz.msgs.TwistWithCovariance`` into a ROS one, without its header."""
    fill_twist(gz.twist, ros.twist)
    covariance_to_ros(gz.covariance.data, ros)


def twist_with_covariance_to_ros(gz: Any) -> TwistWithCovariance:
    """A ``gz.msgs.TwistWithCovariance`` without its header."""
    ros = blank(TwistWithCovariance)
    fill_twist_with_covariance(gz, ros)
    return ros


def copy_twist_with_covariance(ros: TwistWithCovariance, gz: Any) -> None:
    """Write into a ``gz.msgs.TwistWithCovariance``."""
    copy_twist(ros.twist, gz.twist)
    gz.covariance.data.extend(ros.covariance)


@type_pair("geometry_msgs/msg/TwistWithCovarianceStamped", "gz.msgs.TwistWithCovariance")
class TwistWithCovarianceStampedPair:
    """A twist with its covariance; Gazebo keeps the header in the twist."""

    @staticmethod
    def to_ros(gz: Any) -> TwistWithCovarianceStamped:
        """Gazebo to ROS."""
        ros = blank(TwistWithCovarianceStamped)
        fill_header(gz.twist.header, ros.header)
        fill_twist_with_covariance(gz, ros.twist)
        return ros

    @staticmethod
    def to_gz(ros: TwistWithCovarianceStamped) -> Any:
        """ROS to Gazebo."""
        gz = GzTwistWithCovariance()
        header_to_gz(ros.header, gz.twist.header)
        copy_twist_with_covariance(ros.twist, gz)
        return gz

    @staticmethod
    def fault(ros: TwistWithCovarianceStamped) -> str | None:
        """What must not reach the simulator."""
        return not_finite(ros, "twist.twist.linear", "twist.twist.angular")


WRENCH = Fields(Wrench, force=VECTOR3, torque=VECTOR3)
"""Force and torque; Gazebo's ``force_offset`` has no place in ROS."""
add_fields(
    "geometry_msgs/msg/TwistWithCovariance",
    "gz.msgs.TwistWithCovariance",
    Part(twist_with_covariance_to_ros, copy_twist_with_covariance),
    fault=lambda ros: not_finite(ros, "twist.linear", "twist.angular"),
)
add_fields("geometry_msgs/msg/Wrench", "gz.msgs.Wrench", WRENCH, fault=lambda ros: not_finite(ros, "force", "torque"))


@type_pair("geometry_msgs/msg/WrenchStamped", "gz.msgs.Wrench")
class WrenchStampedPair:
    """A wrench with its header."""

    @staticmethod
    def to_ros(gz: Any) -> WrenchStamped:
        """Gazebo to ROS."""
        return WrenchStamped(header=header_to_ros(gz.header), wrench=WRENCH.to_ros(gz))

    @staticmethod
    def to_gz(ros: WrenchStamped) -> Any:
        """ROS to Gazebo."""
        gz = GzWrench()
        header_to_gz(ros.header, gz.header)
        WRENCH.to_gz(ros.wrench, gz)
        return gz

    @staticmethod
    def fault(ros: WrenchStamped) -> str | None:
        """What must not reach the simulator."""
        return not_finite(ros, "wrench.force", "wrench.torque")
