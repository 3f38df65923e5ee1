"""nav_msgs: Odometry, without and with covariances."""

from __future__ import annotations

from typing import Any

from nav_msgs.msg import Odometry

from gz_course.sim.gz.msgs.odometry_pb2 import Odometry as GzOdometry
from gz_course.sim.gz.msgs.odometry_with_covariance_pb2 import OdometryWithCovariance
from gz_course.sim.ros_gz_bridge.blank import blank
from gz_course.sim.ros_gz_bridge.convert.geometry_msgs.poses import (
    copy_pose,
    copy_pose_with_covariance,
    fill_pose,
    fill_pose_with_covariance,
)
from gz_course.sim.ros_gz_bridge.convert.geometry_msgs.twists import (
    copy_twist,
    copy_twist_with_covariance,
    fill_twist,
    fill_twist_with_covariance,
)
from gz_course.sim.ros_gz_bridge.header import CHILD_FRAME_ID, fill_header, header_to_gz, header_value, set_header_value
from gz_course.sim.ros_gz_bridge.type_pairs import type_pair


def _frames_to_ros(gz: Any) -> Odometry:
    ros = blank(Odometry)
    fill_header(gz.header, ros.header)
    ros.child_frame_id = header_value(gz.header, CHILD_FRAME_ID)
    return ros


def _frames_to_gz(ros: Odometry, gz: Any) -> None:
    header_to_gz(ros.header, gz.header)
    set_header_value(gz.header, CHILD_FRAME_ID, ros.child_frame_id)


@type_pair("nav_msgs/msg/Odometry", "gz.msgs.Odometry")
class OdometryPair:
    """Pose and twist; this Gazebo message has no covariances, so ROS gets zeros."""

    @staticmethod
    def to_ros(gz: Any) -> Odometry:
        """Gazebo to ROS."""
        ros = _frames_to_ros(gz)
        fill_pose(gz.pose, ros.pose.pose)
        fill_twist(gz.twist, ros.twist.twist)
        return ros

    @staticmethod
    def to_gz(ros: Odometry) -> Any:
        """ROS to Gazebo."""
        gz = GzOdometry()
        _frames_to_gz(ros, gz)
        copy_pose(ros.pose.pose, gz.pose)
        copy_twist(ros.twist.twist, gz.twist)
        return gz


@type_pair("nav_msgs/msg/Odometry", "gz.msgs.OdometryWithCovariance")
class OdometryWithCovariancePair:
    """Pose and twist with their 6x6 covariances, row by row; a list of another length becomes zeros."""

    @staticmethod
    def to_ros(gz: Any) -> Odometry:
        """Gazebo to ROS."""
        ros = _frames_to_ros(gz)
        fill_pose_with_covariance(gz.pose_with_covariance, ros.pose)
        fill_twist_with_covariance(gz.twist_with_covariance, ros.twist)
        return ros

    @staticmethod
    def to_gz(ros: Odometry) -> Any:
        """ROS to Gazebo."""
        gz = OdometryWithCovariance()
        _frames_to_gz(ros, gz)
        copy_pose_with_covariance(ros.pose, gz.pose_with_covariance)
        copy_twist_with_covariance(ros.twist, gz.twist_with_covariance)
        return gz
