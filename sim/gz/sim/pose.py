"""Rigid transforms and quaternions, used for every frame computation.

Quaternions are (w, x, y, z), Hamilton convention, unit length; lengths are in [m], angles in [rad].

Source: http://sdformat.org/tutorials?tut=specify_pose (roll, pitch, yaw)
Source: https://en.wikipedia.org/wiki/Quaternions_and_spatial_rotation
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
Quaternion = tuple[float, float, float, float]


def _frozen(values: Sequence[float] | Vector, length: int) -> Vector:
    array = np.array(values, dtype=np.float64)
    if array.shape != (length,):
        raise ValueError(f"expected {length} numbers, got {array.shape}")
    array.flags.writeable = False
    return array


@dataclass(frozen=True, eq=False, slots=True)
class Pose:
    """A rigid transform: the `position` [m] of a frame's origin and the orientation `quaternion` (wxyz).

    `parent_child = Pose(...)` maps coordinates of the child frame to coordinates of the parent frame.
    """

    position: Vector
    quaternion: Vector

    def __init__(
        self,
        position: Sequence[float] | Vector = (0.0, 0.0, 0.0),
        quaternion: Sequence[float] | Vector = (1.0, 0.0, 0.0, 0.0),
    ) -> None:
        object.__setattr__(self, "position", _frozen(position, 3))
        object.__setattr__(self, "quaternion", _frozen(quaternion, 4))

    @classmethod
    def from_rpy(cls, position: Sequence[float], rpy: Sequence[float]) -> Pose:
        """Return the pose for SDF's fixed-axis roll, pitch, yaw [rad]: R = Rz(yaw) Ry(pitch) Rx(roll)."""
        return cls(position, quaternion_from_rpy(*rpy))

    def __mul__(self, other: Pose) -> Pose:
        """Chain transforms: `world_model * model_link` is `world_link`."""
        return Pose(
            self.position + rotate(self.quaternion, other.position),
            multiply(self.quaternion, other.quaternion),
        )

    def inverse(self) -> Pose:
        conjugate = self.quaternion * (1.0, -1.0, -1.0, -1.0)
        return Pose(-rotate(conjugate, self.position), conjugate)

    def transform(self, point: Sequence[float] | Vector) -> Vector:
        """Return the coordinates [m] in the parent frame of a point given in the child frame."""
        return self.position + rotate(self.quaternion, np.asarray(point, dtype=np.float64))

    def rpy(self) -> tuple[float, float, float]:
        """Return roll, pitch, yaw [rad] about fixed axes."""
        w, x, y, z = (float(v) for v in self.quaternion)
        sine = max(-1.0, min(1.0, 2.0 * (w * y - z * x)))
        return (
            math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)),
            math.asin(sine),
            math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)),
        )

    def yaw(self) -> float:
        """Return the heading about the z axis, -pi..pi [rad]."""
        return self.rpy()[2]

    def is_close(self, other: Pose, tolerance: float = 1e-9) -> bool:
        """Tell whether both poses are equal within `tolerance` (q and -q are the same rotation)."""
        return bool(
            np.max(np.abs(self.position - other.position)) <= tolerance
            and 1.0 - abs(float(np.dot(self.quaternion, other.quaternion))) <= tolerance
        )


@dataclass(frozen=True, eq=False, slots=True)
class Velocity:
    """Velocity of a frame relative to the world, in world axes: `linear` [m/s] of its origin and `angular` [rad/s]."""

    linear: Vector
    angular: Vector


def quaternion_from_rpy(roll: float, pitch: float, yaw: float) -> Vector:
    """Return the unit quaternion (wxyz) of fixed-axis roll, pitch, yaw [rad]."""
    cr, sr = math.cos(roll / 2.0), math.sin(roll / 2.0)
    cp, sp = math.cos(pitch / 2.0), math.sin(pitch / 2.0)
    cy, sy = math.cos(yaw / 2.0), math.sin(yaw / 2.0)
    return np.array(
        (
            cr * cp * cy + sr * sp * sy,
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
        )
    )


def multiply(a: Vector, b: Vector) -> Vector:
    """Return the Hamilton product of two quaternions (wxyz)."""
    return np.array(product(a.tolist(), b.tolist()))


def product(a: Sequence[float], b: Sequence[float]) -> Quaternion:
    """Return the Hamilton product of two quaternions (wxyz) in plain floats, which are faster than arrays."""
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return (
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    )


def rotate(quaternion: Vector, vector: Vector) -> Vector:
    """Return `vector` rotated by `quaternion` (wxyz)."""
    return np.array(rotated(quaternion.tolist(), vector.tolist()))


def rotated(quaternion: Sequence[float], vector: Sequence[float]) -> tuple[float, float, float]:
    """Return `vector` rotated by `quaternion` (wxyz) in plain floats, which are faster than arrays."""
    w, x, y, z = quaternion
    vx, vy, vz = vector
    # v + 2 w (q x v) + 2 q x (q x v)
    tx, ty, tz = 2.0 * (y * vz - z * vy), 2.0 * (z * vx - x * vz), 2.0 * (x * vy - y * vx)
    return (
        vx + w * tx + y * tz - z * ty,
        vy + w * ty + z * tx - x * tz,
        vz + w * tz + x * ty - y * tx,
    )


def matrix(quaternion: Vector) -> NDArray[np.float64]:
    """Return the rotation matrix (3, 3) of a unit quaternion (wxyz)."""
    w, x, y, z = (float(v) for v in quaternion)
    return np.array(
        (
            (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
        )
    )


def quaternion_between(start: Sequence[float] | Vector, end: Sequence[float] | Vector) -> Vector:
    """Return the shortest rotation (wxyz) from direction `start` to direction `end`."""
    a = np.asarray(start, dtype=np.float64) / np.linalg.norm(start)
    b = np.asarray(end, dtype=np.float64) / np.linalg.norm(end)
    dot = float(a @ b)
    if dot < -1.0 + 1e-12:
        helper = np.array((1.0, 0.0, 0.0)) if abs(a[0]) < 0.9 else np.array((0.0, 1.0, 0.0))
        axis = np.cross(a, helper)
        axis /= np.linalg.norm(axis)
        return np.array((0.0, *axis))
    quaternion = np.array((1.0 + dot, *np.cross(a, b)))
    return quaternion / np.linalg.norm(quaternion)


IDENTITY = Pose()
