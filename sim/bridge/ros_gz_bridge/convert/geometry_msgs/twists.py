"""Twists (velocity) and wrenches (force and torque). Commands must be finite.

Source: ros_gz_bridge/src/convert/geometry_msgs.cpp, https://github.com/gazebosim/ros_gz
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from typing import Any

from geometry_msgs import msg

from gz_course.sim.bridge.ros_gz_bridge.convert.geometry_msgs.poses import VECTOR3, copy_xyz, with_covariance
from gz_course.sim.bridge.ros_gz_bridge.fields import Fields, Part, message_pair, stamped


def _copy_twist(source: Any, target: Any) -> None:
    copy_xyz(source.linear, target.linear)
    copy_xyz(source.angular, target.angular)


def finite(*paths: str) -> Callable[[Any], str | None]:
    """Return a check that names the numbers of a message that are not finite (`"linear.x is nan"`), or returns None.

    Each path leads to a number of the message or to a message whose numbers are `x, y, z` (and `w`).
    """
    getters = [(path, operator.attrgetter(path)) for path in paths]

    def fault(message: Any) -> str | None:
        bad = []
        for path, get in getters:
            value = get(message)
            if isinstance(value, float):
                numbers = [(path, value)]
            else:
                axes = "xyzw" if isinstance(value, msg.Quaternion) else "xyz"
                if math.isfinite(sum([getattr(value, axis) for axis in axes])):
                    continue  # the common case: a sum is finite only if all numbers are
                numbers = [(f"{path}.{axis}", getattr(value, axis)) for axis in axes]
            bad += [f"{name} is {number}" for name, number in numbers if not math.isfinite(number)]
        return ", ".join(bad) or None

    return fault


TWIST = Part(msg.Twist, _copy_twist, _copy_twist)
TWIST_WITH_COVARIANCE = with_covariance(msg.TwistWithCovariance, "twist", TWIST)
WRENCH = Fields(msg.Wrench, force=VECTOR3, torque=VECTOR3)
"""Force and torque; Gazebo's `force_offset` has no field in ROS."""

message_pair("geometry_msgs/msg/Twist", "gz.msgs.Twist", TWIST, finite("linear", "angular"))
message_pair(
    "geometry_msgs/msg/TwistStamped",
    "gz.msgs.Twist",
    stamped(msg.TwistStamped, "twist", TWIST),
    finite("twist.linear", "twist.angular"),
)
message_pair(
    "geometry_msgs/msg/TwistWithCovariance",
    "gz.msgs.TwistWithCovariance",
    TWIST_WITH_COVARIANCE,
    finite("twist.linear", "twist.angular"),
)
message_pair(
    "geometry_msgs/msg/TwistWithCovarianceStamped",
    "gz.msgs.TwistWithCovariance",
    stamped(msg.TwistWithCovarianceStamped, "twist", TWIST_WITH_COVARIANCE, gz_header="twist.header"),
    finite("twist.twist.linear", "twist.twist.angular"),
)
message_pair("geometry_msgs/msg/Wrench", "gz.msgs.Wrench", WRENCH, finite("force", "torque"))
message_pair(
    "geometry_msgs/msg/WrenchStamped",
    "gz.msgs.Wrench",
    stamped(msg.WrenchStamped, "wrench", WRENCH),
    finite("wrench.force", "wrench.torque"),
)
