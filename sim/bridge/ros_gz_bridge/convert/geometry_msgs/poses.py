"""Vectors, rotations, poses and transforms."""

from __future__ import annotations

from typing import Any

import numpy as np
from geometry_msgs import msg

from gz_course.sim.bridge.ros_gz_bridge.fields import HEADER, Each, Fields, Part, message_pair, stamped
from gz_course.sim.bridge.ros_gz_bridge.header import (
    CHILD_FRAME_ID,
    copy_header,
    fill_header,
    header_value,
    set_header_value,
)


def copy_xyz(source: Any, target: Any) -> None:
    """Copy a vector or point between the two sides, in either direction."""
    target.x, target.y, target.z = source.x, source.y, source.z


def copy_xyzw(source: Any, target: Any) -> None:
    """Copy a quaternion between the two sides, in either direction."""
    target.x, target.y, target.z, target.w = source.x, source.y, source.z, source.w


def _copy_pose(source: Any, target: Any) -> None:
    copy_xyz(source.position, target.position)
    copy_xyzw(source.orientation, target.orientation)


def _fill_transform(gz: Any, ros: msg.Transform) -> None:
    copy_xyz(gz.position, ros.translation)
    copy_xyzw(gz.orientation, ros.rotation)


def _copy_transform(ros: msg.Transform, gz: Any) -> None:
    copy_xyz(ros.translation, gz.position)
    copy_xyzw(ros.rotation, gz.orientation)


def fill_frames(gz: Any, ros: Any) -> None:
    """Write the header and the child frame, which are both in the Gazebo header, into a ROS message.

    Source: REP-105, https://www.ros.org/reps/rep-0105.html
    """
    fill_header(gz.header, ros.header)
    ros.child_frame_id = header_value(gz.header, CHILD_FRAME_ID, first=True)


def copy_frames(ros: Any, gz: Any) -> None:
    """Write header and child frame of a ROS message into the header of a Gazebo message."""
    copy_header(ros.header, gz.header)
    set_header_value(gz.header, CHILD_FRAME_ID, ros.child_frame_id)


def _fill_transform_stamped(gz: Any, ros: msg.TransformStamped) -> None:
    fill_frames(gz, ros)
    _fill_transform(gz, ros.transform)


def _copy_transform_stamped(ros: msg.TransformStamped, gz: Any) -> None:
    copy_frames(ros, gz)
    _copy_transform(ros.transform, gz)


def with_covariance(ros_class: Any, field: str, part: Part) -> Part:
    """Return the part of a message with `part` in `field` and a row-major covariance (6, 6).

    If the Gazebo list has another length the ROS covariance stays zero.
    """

    def fill(gz: Any, ros: Any) -> None:
        part.fill(getattr(gz, field), getattr(ros, field))
        if len(gz.covariance.data) == 36:
            ros.covariance = np.array(gz.covariance.data, dtype=np.float64)

    def copy(ros: Any, gz: Any) -> None:
        part.copy(getattr(ros, field), getattr(gz, field))
        gz.covariance.data.extend(ros.covariance)

    return Part(ros_class, fill, copy)


VECTOR3 = Part(msg.Vector3, copy_xyz, copy_xyz)
POSE = Part(msg.Pose, _copy_pose, _copy_pose)
"""Position and orientation; name and id of the Gazebo message have no field in ROS."""
POSE_WITH_COVARIANCE = with_covariance(msg.PoseWithCovariance, "pose", POSE)
TRANSFORM_STAMPED = Part(msg.TransformStamped, _fill_transform_stamped, _copy_transform_stamped)

message_pair("geometry_msgs/msg/Vector3", "gz.msgs.Vector3d", VECTOR3)
message_pair("geometry_msgs/msg/Point", "gz.msgs.Vector3d", Part(msg.Point, copy_xyz, copy_xyz))
message_pair("geometry_msgs/msg/Quaternion", "gz.msgs.Quaternion", Part(msg.Quaternion, copy_xyzw, copy_xyzw))
message_pair("geometry_msgs/msg/Pose", "gz.msgs.Pose", POSE)
message_pair("geometry_msgs/msg/PoseStamped", "gz.msgs.Pose", stamped(msg.PoseStamped, "pose", POSE))
message_pair("geometry_msgs/msg/Transform", "gz.msgs.Pose", Part(msg.Transform, _fill_transform, _copy_transform))
message_pair("geometry_msgs/msg/TransformStamped", "gz.msgs.Pose", TRANSFORM_STAMPED)
message_pair("geometry_msgs/msg/PoseWithCovariance", "gz.msgs.PoseWithCovariance", POSE_WITH_COVARIANCE)
message_pair(
    "geometry_msgs/msg/PoseWithCovarianceStamped",
    "gz.msgs.PoseWithCovariance",
    stamped(msg.PoseWithCovarianceStamped, "pose", POSE_WITH_COVARIANCE, gz_header="pose.header"),
)
message_pair(
    "geometry_msgs/msg/PoseArray",
    "gz.msgs.Pose_V",
    Fields(msg.PoseArray, {"poses": "pose"}, header=HEADER, poses=Each(POSE)),
)
