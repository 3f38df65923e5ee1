"""geometry_msgs poses and points, and nav_msgs/Path: arrows, points and a line."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

ARROW = 0.4  # [m] length of the arrow of a pose
COLOUR = (60, 160, 90)


def triple(point: Any) -> tuple[float, float, float]:
    return point.x, point.y, point.z


def quaternion(turn: Any) -> list[float]:
    """Return x, y, z, w; no turn for a quaternion of zeros, which a message has that was not filled in."""
    values = [turn.x, turn.y, turn.z, turn.w]
    return values if any(values) else [0.0, 0.0, 0.0, 1.0]


def forward(turn: Any) -> list[float]:
    """Return the x axis of a pose.

    Source: https://en.wikipedia.org/wiki/Quaternions_and_spatial_rotation
    """
    x, y, z, w = quaternion(turn)
    return [ARROW * (1 - 2 * (y * y + z * z)), ARROW * 2 * (x * y + z * w), ARROW * 2 * (x * z - y * w)]


def _arrows(canvas: Any, entity: str, frame: str, poses: Sequence[Any]) -> None:
    import rerun as rr

    canvas.in_frame(entity, frame)
    origins = [triple(each.position) for each in poses]
    vectors = [forward(each.orientation) for each in poses]
    canvas.log(entity, rr.Arrows3D(origins=origins, vectors=vectors, colors=[COLOUR], radii=0.015))


def draw_pose(canvas: Any, entity: str, message: Any) -> None:
    pose = message.pose.pose if hasattr(message.pose, "pose") else message.pose
    _arrows(canvas, entity, message.header.frame_id, [pose])


def draw_array(canvas: Any, entity: str, message: Any) -> None:
    _arrows(canvas, entity, message.header.frame_id, message.poses)


def draw_path(canvas: Any, entity: str, message: Any) -> None:
    import rerun as rr

    canvas.in_frame(entity, message.header.frame_id)
    line = [triple(each.pose.position) for each in message.poses]
    canvas.log(entity, rr.LineStrips3D([line], colors=[COLOUR], radii=0.015))


def draw_point(canvas: Any, entity: str, message: Any) -> None:
    import rerun as rr

    canvas.in_frame(entity, message.header.frame_id)
    canvas.log(entity, rr.Points3D([triple(message.point)], colors=[COLOUR], radii=0.05))


DRAWN = {
    "geometry_msgs/msg/PoseStamped": draw_pose,
    "geometry_msgs/msg/PoseWithCovarianceStamped": draw_pose,
    "geometry_msgs/msg/PoseArray": draw_array,
    "geometry_msgs/msg/PointStamped": draw_point,
    "nav_msgs/msg/Path": draw_path,
}
