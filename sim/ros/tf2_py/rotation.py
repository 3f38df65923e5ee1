"""Quaternions and poses as tuples of floats: (x, y, z, w) and (position x, y, z, quaternion x, y, z, w).

Tuples, because for single poses they are several times as fast as numpy arrays.

Source: tf2/include/tf2/LinearMath/Quaternion.hpp and Matrix3x3.hpp of https://github.com/ros2/geometry2
"""

from __future__ import annotations

import math

Quaternion = tuple[float, float, float, float]
Pose = tuple[float, float, float, float, float, float, float]

IDENTITY: Pose = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)


def canonical(x: float, y: float, z: float, w: float) -> Quaternion:
    """Return the unit quaternion of a rotation with the sign that it has after a conversion from a matrix.

    The result is NaN for a quaternion of length zero, and for one that is not finite.
    """
    length = math.sqrt(x * x + y * y + z * z + w * w)
    if not 0.0 < length < math.inf:
        return math.nan, math.nan, math.nan, math.nan
    x, y, z, w = x / length, y / length, z / length, w / length
    # The trace of the matrix is 4 w² - 1. If it is positive, w is, and else the largest of the others.
    sign = w if w * w > 0.25 else max(x, y, z, key=abs)
    return (x, y, z, w) if sign >= 0.0 else (-x, -y, -z, -w)


def combine(outer: Pose, inner: Pose) -> Pose:
    """Return the pose `inner`, given in the frame of `outer`, in the frame in which `outer` is given."""
    px, py, pz, ax, ay, az, aw = outer
    x, y, z, bx, by, bz, bw = inner
    # v + 2 w (a x v) + 2 a x (a x v)
    tx, ty, tz = 2.0 * (ay * z - az * y), 2.0 * (az * x - ax * z), 2.0 * (ax * y - ay * x)
    return (
        px + x + aw * tx + ay * tz - az * ty,
        py + y + aw * ty + az * tx - ax * tz,
        pz + z + aw * tz + ax * ty - ay * tx,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by + ay * bw + az * bx - ax * bz,
        aw * bz + az * bw + ax * by - ay * bx,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def inverse(pose: Pose) -> Pose:
    """Return the inverse of a pose whose quaternion has the length 1."""
    x, y, z, qx, qy, qz, qw = pose
    return combine((0.0, 0.0, 0.0, -qx, -qy, -qz, qw), (-x, -y, -z, 0.0, 0.0, 0.0, 1.0))


def slerp(one: Quaternion, two: Quaternion, ratio: float) -> Quaternion:
    """Return the rotation at `ratio` on the shorter way from `one` (0) to `two` (1)."""
    dot = one[0] * two[0] + one[1] * two[1] + one[2] * two[2] + one[3] * two[3]
    angle = math.acos(min(1.0, abs(dot)))
    sine = math.sin(angle)
    if sine == 0.0:
        return one
    first = math.sin((1.0 - ratio) * angle) / sine
    second = math.copysign(math.sin(ratio * angle) / sine, dot)
    return (
        first * one[0] + second * two[0],
        first * one[1] + second * two[1],
        first * one[2] + second * two[2],
        first * one[3] + second * two[3],
    )
