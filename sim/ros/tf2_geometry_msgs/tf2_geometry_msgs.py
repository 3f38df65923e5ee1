"""The functions that apply a TransformStamped to points, vectors, poses, twists and wrenches.

What is returned has the header of the transform. The arguments are not changed. A rotation that is no unit quaternion
counts as the one in its direction, 0 0 0 0 as no rotation.

Source: tf2_geometry_msgs/src/tf2_geometry_msgs/tf2_geometry_msgs.py and, for wrenches and polygons,
tf2_geometry_msgs/include/tf2_geometry_msgs/tf2_geometry_msgs.hpp of https://github.com/ros2/geometry2
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
from geometry_msgs.msg import (
    Point,
    Point32,
    PointStamped,
    PolygonStamped,
    Pose,
    PoseStamped,
    PoseWithCovarianceStamped,
    Quaternion,
    TransformStamped,
    Twist,
    TwistStamped,
    Vector3,
    Vector3Stamped,
    Wrench,
    WrenchStamped,
)

from gz_course.sim.ros.tf2_py import rotation
from gz_course.sim.ros.tf2_ros.buffer_interface import ConvertRegistration, TransformRegistration


def to_msg_msg(msg: Any) -> Any:
    return msg


def from_msg_msg(msg: Any) -> Any:
    return msg


def do_transform_point(point: PointStamped, transform: TransformStamped) -> PointStamped:
    done = PointStamped(header=transform.header)
    done.point = _point(_moved(transform, point.point))
    return done


def do_transform_vector3(vector3: Vector3Stamped, transform: TransformStamped) -> Vector3Stamped:
    """Return a vector in the other frame: a direction with a length, which is only rotated."""
    return Vector3Stamped(header=transform.header, vector=_rotated(transform, vector3.vector))


def do_transform_pose(pose: Pose, transform: TransformStamped) -> Pose:
    place, turn = pose.position, _unit(pose.orientation)
    done = rotation.combine(_pose(transform), (place.x, place.y, place.z, *turn))
    x, y, z, w = done[3:]
    sign = -1.0 if w < 0.0 else 1.0
    return Pose(position=_point(done), orientation=Quaternion(x=sign * x, y=sign * y, z=sign * z, w=sign * w))


def do_transform_pose_stamped(pose: PoseStamped, transform: TransformStamped) -> PoseStamped:
    return PoseStamped(header=transform.header, pose=do_transform_pose(pose.pose, transform))


def do_transform_pose_with_covariance_stamped(
    pose: PoseWithCovarianceStamped, transform: TransformStamped
) -> PoseWithCovarianceStamped:
    done = PoseWithCovarianceStamped(header=transform.header)
    done.pose.pose = do_transform_pose(pose.pose.pose, transform)
    done.pose.covariance = transform_covariance(pose.pose.covariance, transform)
    return done


def transform_covariance(cov_in: Any, transform: TransformStamped) -> npt.NDArray[np.float64]:
    """Return the covariance of a pose, 36 numbers by rows, in the other frame: each 3x3 block C becomes R C R^T."""
    x, y, z, w = _unit(transform.transform.rotation)
    columns = [
        rotation.combine((0.0, 0.0, 0.0, x, y, z, w), (*axis, 0.0, 0.0, 0.0, 1.0))[:3]
        for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    ]
    matrix = np.kron(np.eye(2), np.array(columns).T)
    done: npt.NDArray[np.float64] = matrix @ np.asarray(cov_in, dtype=np.float64).reshape(6, 6) @ matrix.T
    return done.reshape(36)


def do_transform_wrench(wrench: Wrench, transform: TransformStamped) -> Wrench:
    """Return a wrench in the directions of the other frame; the torque stays about the same point."""
    return Wrench(force=_rotated(transform, wrench.force), torque=_rotated(transform, wrench.torque))


def do_transform_wrench_stamped(wrench: WrenchStamped, transform: TransformStamped) -> WrenchStamped:
    return WrenchStamped(header=transform.header, wrench=do_transform_wrench(wrench.wrench, transform))


def do_transform_twist(twist: Twist, transform: TransformStamped) -> Twist:
    """Return a twist of the same rigid body about the origin of the other frame: v becomes R v + p x R w.

    Source: PyKDL's Frame * Twist, http://docs.ros.org/en/latest/api/orocos_kdl/html/classKDL_1_1Frame.html
    """
    linear, angular = _rotated(transform, twist.linear), _rotated(transform, twist.angular)
    place = transform.transform.translation
    linear.x += place.y * angular.z - place.z * angular.y
    linear.y += place.z * angular.x - place.x * angular.z
    linear.z += place.x * angular.y - place.y * angular.x
    return Twist(linear=linear, angular=angular)


def do_transform_twist_stamped(twist: TwistStamped, transform: TransformStamped) -> TwistStamped:
    return TwistStamped(header=transform.header, twist=do_transform_twist(twist.twist, transform))


def do_transform_polygon_stamped(polygon: PolygonStamped, transform: TransformStamped) -> PolygonStamped:
    done = PolygonStamped(header=transform.header)
    moved = (_moved(transform, each) for each in polygon.polygon.points)
    done.polygon.points = [Point32(x=each[0], y=each[1], z=each[2]) for each in moved]
    return done


def _unit(turn: Quaternion) -> rotation.Quaternion:
    unit = rotation.canonical(turn.x, turn.y, turn.z, turn.w)
    return (0.0, 0.0, 0.0, 1.0) if math.isnan(unit[0]) else unit


def _pose(transform: TransformStamped) -> rotation.Pose:
    place = transform.transform.translation
    return place.x, place.y, place.z, *_unit(transform.transform.rotation)


def _moved(transform: TransformStamped, point: Any) -> rotation.Pose:
    return rotation.combine(_pose(transform), (point.x, point.y, point.z, 0.0, 0.0, 0.0, 1.0))


def _point(pose: rotation.Pose) -> Point:
    return Point(x=pose[0], y=pose[1], z=pose[2])


def _rotated(transform: TransformStamped, vector: Vector3) -> Vector3:
    turn = (0.0, 0.0, 0.0, *_unit(transform.transform.rotation))
    x, y, z, *_ = rotation.combine(turn, (vector.x, vector.y, vector.z, 0.0, 0.0, 0.0, 1.0))
    return Vector3(x=x, y=y, z=z)


for _type, _function in (
    (PointStamped, do_transform_point),
    (Vector3Stamped, do_transform_vector3),
    (PoseStamped, do_transform_pose_stamped),
    (PoseWithCovarianceStamped, do_transform_pose_with_covariance_stamped),
    (WrenchStamped, do_transform_wrench_stamped),
    (TwistStamped, do_transform_twist_stamped),
    (PolygonStamped, do_transform_polygon_stamped),
):
    TransformRegistration().add(_type, _function)
    ConvertRegistration().add_to_msg(_type, to_msg_msg)
    ConvertRegistration().add_from_msg(_type, from_msg_msg)
