"""Vectors, rotations, poses and transforms: where something is."""

from __future__ import annotations

from typing import Any

import numpy as np
from geometry_msgs.msg import (
    Point,
    Pose,
    PoseArray,
    PoseStamped,
    PoseWithCovariance,
    PoseWithCovarianceStamped,
    Quaternion,
    Transform,
    TransformStamped,
    Vector3,
)

from gz_course.sim.gz.msgs.pose_pb2 import Pose as GzPose
from gz_course.sim.gz.msgs.pose_with_covariance_pb2 import PoseWithCovariance as GzPoseWithCovariance
from gz_course.sim.gz.msgs.quaternion_pb2 import Quaternion as GzQuaternion
from gz_course.sim.gz.msgs.vector3d_pb2 import Vector3d
from gz_course.sim.ros_gz_bridge.blank import blank
from gz_course.sim.ros_gz_bridge.fields import HEADER, Each, Fields, Part, add_fields
from gz_course.sim.ros_gz_bridge.header import CHILD_FRAME_ID, fill_header, header_to_gz, header_value, set_header_value
from gz_course.sim.ros_gz_bridge.type_pairs import type_pair


def fill_xyz(gz: Any, ros: Vector3 | Point) -> None:
    """Write a ``gz.msgs.Vector3d`` into a ROS vector or point."""
    ros.x, ros.y, ros.z = gz.x, gz.y, gz.z


def fill_xyzw(gz: Any, ros: Quaternion) -> None:
    """Write a ``gz.msgs.Quaternion`` into a ROS quaternion; one never filled in is 0, 0, 0, 0 on both sides."""
    ros.x, ros.y, ros.z, ros.w = gz.x, gz.y, gz.z, gz.w


def vector_to_ros(gz: Any) -> Vector3:
    """A ``gz.msgs.Vector3d`` as a ROS vector."""
    ros = Vector3()
    fill_xyz(gz, ros)
    return ros


def point_to_ros(gz: Any) -> Point:
    """A ``gz.msgs.Vector3d`` as a ROS point."""
    ros = Point()
    fill_xyz(gz, ros)
    return ros


def quaternion_to_ros(gz: Any) -> Quaternion:
    """A ``gz.msgs.Quaternion`` as a ROS quaternion."""
    ros = Quaternion()
    fill_xyzw(gz, ros)
    return ros


def copy_xyz(ros: Any, gz: Any) -> None:
    """Write x, y, z of a ROS vector or point into ``gz``."""
    gz.x, gz.y, gz.z = ros.x, ros.y, ros.z


def copy_xyzw(ros: Quaternion, gz: Any) -> None:
    """Write a ROS quaternion into ``gz``."""
    gz.x, gz.y, gz.z, gz.w = ros.x, ros.y, ros.z, ros.w


def fill_pose(gz: Any, ros: Pose) -> None:
    """Write position and orientation of a ``gz.msgs.Pose`` into a ROS pose; its name and id have no place there."""
    fill_xyz(gz.position, ros.position)
    fill_xyzw(gz.orientation, ros.orientation)


def pose_to_ros(gz: Any) -> Pose:
    """Position and orientation of a ``gz.msgs.Pose``."""
    ros = blank(Pose)
    fill_pose(gz, ros)
    return ros


def copy_pose(ros: Pose, gz: Any) -> None:
    """Write a ROS pose into ``gz``."""
    copy_xyz(ros.position, gz.position)
    copy_xyzw(ros.orientation, gz.orientation)


def fill_transform(gz: Any, ros: Transform) -> None:
    """Write a ``gz.msgs.Pose`` into a ROS transform."""
    fill_xyz(gz.position, ros.translation)
    fill_xyzw(gz.orientation, ros.rotation)


def transform_to_ros(gz: Any) -> Transform:
    """A ``gz.msgs.Pose`` as a ROS transform."""
    ros = blank(Transform)
    fill_transform(gz, ros)
    return ros


def copy_transform(ros: Transform, gz: Any) -> None:
    """Write a ROS transform into ``gz`` (a ``gz.msgs.Pose``)."""
    copy_xyz(ros.translation, gz.position)
    copy_xyzw(ros.rotation, gz.orientation)


def copy_transform_stamped(ros: TransformStamped, gz: Any) -> None:
    """Write a stamped ROS transform with both its frames into ``gz`` (a ``gz.msgs.Pose``)."""
    header_to_gz(ros.header, gz.header)
    set_header_value(gz.header, CHILD_FRAME_ID, ros.child_frame_id)
    copy_transform(ros.transform, gz)


@type_pair("geometry_msgs/msg/Vector3", "gz.msgs.Vector3d")
class Vector3Pair:
    """Three numbers."""

    to_ros = staticmethod(vector_to_ros)

    @staticmethod
    def to_gz(ros: Vector3) -> Any:
        """ROS to Gazebo."""
        return Vector3d(x=ros.x, y=ros.y, z=ros.z)


@type_pair("geometry_msgs/msg/Point", "gz.msgs.Vector3d")
class PointPair:
    """Three coordinates."""

    to_ros = staticmethod(point_to_ros)

    @staticmethod
    def to_gz(ros: Point) -> Any:
        """ROS to Gazebo."""
        return Vector3d(x=ros.x, y=ros.y, z=ros.z)


@type_pair("geometry_msgs/msg/Quaternion", "gz.msgs.Quaternion")
class QuaternionPair:
    """A rotation, x, y, z, w."""

    to_ros = staticmethod(quaternion_to_ros)

    @staticmethod
    def to_gz(ros: Quaternion) -> Any:
        """ROS to Gazebo."""
        return GzQuaternion(x=ros.x, y=ros.y, z=ros.z, w=ros.w)


@type_pair("geometry_msgs/msg/Pose", "gz.msgs.Pose")
class PosePair:
    """Position and orientation."""

    to_ros = staticmethod(pose_to_ros)

    @staticmethod
    def to_gz(ros: Pose) -> Any:
        """ROS to Gazebo."""
        gz = GzPose()
        copy_pose(ros, gz)
        return gz


@type_pair("geometry_msgs/msg/PoseStamped", "gz.msgs.Pose")
class PoseStampedPair:
    """A pose with its header."""

    @staticmethod
    def to_ros(gz: Any) -> PoseStamped:
        """Gazebo to ROS."""
        ros = blank(PoseStamped)
        fill_header(gz.header, ros.header)
        fill_pose(gz, ros.pose)
        return ros

    @staticmethod
    def to_gz(ros: PoseStamped) -> Any:
        """ROS to Gazebo."""
        gz = GzPose()
        header_to_gz(ros.header, gz.header)
        copy_pose(ros.pose, gz)
        return gz


@type_pair("geometry_msgs/msg/Transform", "gz.msgs.Pose")
class TransformPair:
    """A pose read as a transform."""

    to_ros = staticmethod(transform_to_ros)

    @staticmethod
    def to_gz(ros: Transform) -> Any:
        """ROS to Gazebo."""
        gz = GzPose()
        copy_transform(ros, gz)
        return gz


@type_pair("geometry_msgs/msg/TransformStamped", "gz.msgs.Pose")
class TransformStampedPair:
    """A transform with both its frames; the child's name is in the Gazebo header too."""

    @staticmethod
    def to_ros(gz: Any) -> TransformStamped:
        """Gazebo to ROS."""
        ros = blank(TransformStamped)
        fill_header(gz.header, ros.header)
        ros.child_frame_id = header_value(gz.header, CHILD_FRAME_ID)
        fill_transform(gz, ros.transform)
        return ros

    @staticmethod
    def to_gz(ros: TransformStamped) -> Any:
        """ROS to Gazebo."""
        gz = GzPose()
        copy_transform_stamped(ros, gz)
        return gz


def covariance_to_ros(numbers: Any, ros: Any) -> None:
    """Row-major 6x6 covariance into ``ros.covariance``; a list of another length leaves it zero."""
    if len(numbers) == 36:
        ros.covariance = np.array(numbers, dtype=np.float64)


def fill_pose_with_covariance(gz: Any, ros: PoseWithCovariance) -> None:
    """Write a ``gz.msgs.PoseWithCovariance`` into a ROS one, without its header."""
    fill_pose(gz.pose, ros.pose)
    covariance_to_ros(gz.covariance.data, ros)


def pose_with_covariance_to_ros(gz: Any) -> PoseWithCovariance:
    """A ``gz.msgs.PoseWithCovariance`` without its header."""
    ros = blank(PoseWithCovariance)
    fill_pose_with_covariance(gz, ros)
    return ros


def copy_pose_with_covariance(ros: PoseWithCovariance, gz: Any) -> None:
    """Write into a ``gz.msgs.PoseWithCovariance``."""
    copy_pose(ros.pose, gz.pose)
    gz.covariance.data.extend(ros.covariance)


@type_pair("geometry_msgs/msg/PoseWithCovarianceStamped", "gz.msgs.PoseWithCovariance")
class PoseWithCovarianceStampedPair:
    """A pose with its covariance; Gazebo keeps the header in the pose."""

    @staticmethod
    def to_ros(gz: Any) -> PoseWithCovarianceStamped:
        """Gazebo to ROS."""
        ros = blank(PoseWithCovarianceStamped)
        fill_header(gz.pose.header, ros.header)
        fill_pose_with_covariance(gz, ros.pose)
        return ros

    @staticmethod
    def to_gz(ros: PoseWithCovarianceStamped) -> Any:
        """ROS to Gazebo."""
        gz = GzPoseWithCovariance()
        header_to_gz(ros.header, gz.pose.header)
        copy_pose_with_covariance(ros.pose, gz)
        return gz


VECTOR3 = Part(vector_to_ros, copy_xyz)
POSE = Part(pose_to_ros, copy_pose)
add_fields(
    "geometry_msgs/msg/PoseArray",
    "gz.msgs.Pose_V",
    Fields(PoseArray, {"poses": "pose"}, header=HEADER, poses=Each(POSE)),
)
add_fields(
    "geometry_msgs/msg/PoseWithCovariance",
    "gz.msgs.PoseWithCovariance",
    Part(pose_with_covariance_to_ros, copy_pose_with_covariance),
)
