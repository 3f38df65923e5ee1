"""nav_msgs: Odometry, without and with covariances.

Source: ros_gz_bridge/src/convert/nav_msgs.cpp, https://github.com/gazebosim/ros_gz
"""

from __future__ import annotations

from typing import Any

from nav_msgs.msg import Odometry

from gz_course.sim.bridge.ros_gz_bridge.convert.geometry_msgs.poses import (
    POSE,
    POSE_WITH_COVARIANCE,
    copy_frames,
    fill_frames,
)
from gz_course.sim.bridge.ros_gz_bridge.convert.geometry_msgs.twists import TWIST, TWIST_WITH_COVARIANCE
from gz_course.sim.bridge.ros_gz_bridge.fields import Part, message_pair


def _fill(gz: Any, ros: Odometry) -> None:
    """Write pose and twist; this Gazebo message has no covariances, so ROS gets zeros."""
    fill_frames(gz, ros)
    POSE.fill(gz.pose, ros.pose.pose)
    TWIST.fill(gz.twist, ros.twist.twist)


def _copy(ros: Odometry, gz: Any) -> None:
    copy_frames(ros, gz)
    POSE.copy(ros.pose.pose, gz.pose)
    TWIST.copy(ros.twist.twist, gz.twist)


def _fill_with_covariance(gz: Any, ros: Odometry) -> None:
    fill_frames(gz, ros)
    POSE_WITH_COVARIANCE.fill(gz.pose_with_covariance, ros.pose)
    TWIST_WITH_COVARIANCE.fill(gz.twist_with_covariance, ros.twist)


def _copy_with_covariance(ros: Odometry, gz: Any) -> None:
    copy_frames(ros, gz)
    POSE_WITH_COVARIANCE.copy(ros.pose, gz.pose_with_covariance)
    TWIST_WITH_COVARIANCE.copy(ros.twist, gz.twist_with_covariance)


message_pair("nav_msgs/msg/Odometry", "gz.msgs.Odometry", Part(Odometry, _fill, _copy))
message_pair(
    "nav_msgs/msg/Odometry",
    "gz.msgs.OdometryWithCovariance",
    Part(Odometry, _fill_with_covariance, _copy_with_covariance),
)
