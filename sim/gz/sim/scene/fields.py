"""Writes poses, vectors, colours and stamps into fields of Gazebo messages, in place."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from gz_course.sim.gz.sim.pose import Pose


def fill_pose(field: Any, position: Iterable[float], quaternion: Iterable[float]) -> None:
    """Write position [m] and unit quaternion (wxyz) into a gz.msgs.Pose."""
    field.position.x, field.position.y, field.position.z = (float(value) for value in position)
    at = field.orientation
    at.w, at.x, at.y, at.z = (float(value) for value in quaternion)


def set_pose(field: Any, pose: Pose) -> None:
    fill_pose(field, pose.position, pose.quaternion)


def set_vector(field: Any, values: Iterable[float]) -> None:
    """Write two or three numbers into a gz.msgs.Vector2d or gz.msgs.Vector3d."""
    for name, value in zip("xyz", values, strict=False):
        setattr(field, name, float(value))


def set_colour(field: Any, rgba: Sequence[float]) -> None:
    """Write three or four numbers (0..1) into a gz.msgs.Color; three numbers make an opaque colour."""
    field.r, field.g, field.b = (float(value) for value in rgba[:3])
    field.a = float(rgba[3]) if len(rgba) == 4 else 1.0


def set_stamp(header: Any, now_ns: int) -> None:
    """Write simulated time [ns] into the stamp of a gz.msgs.Header."""
    header.stamp.sec, header.stamp.nsec = divmod(now_ns, 1_000_000_000)
