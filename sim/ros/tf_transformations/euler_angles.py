"""Euler angles [rad] about three axes, to and from quaternions and matrices.

A sequence of axes is a text such as `sxyz`: `s` for axes that stand still, `r` for axes that turn with the body, then
the axes in their order; or the four numbers (first axis, odd, first axis again, turning). The default is roll, pitch
and yaw of ROS.

Source: K. Shoemake, Euler Angle Conversion, in Graphics Gems IV
Source: https://github.com/DLu/tf_transformations
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from gz_course.sim.ros.tf_transformations.matrices import quaternion_matrix
from gz_course.sim.ros.tf_transformations.quaternions import Quaternion, quaternion_multiply

_EPSILON = 4.0 * float(np.finfo(float).eps)

Axes = str | tuple[int, int, int, int]


def quaternion_from_euler(ai: float, aj: float, ak: float, axes: Axes = "sxyz") -> Quaternion:
    """Return the quaternion (x, y, z, w) of three rotations, by default roll, pitch and yaw."""
    order, turning = _order(axes)
    quaternion: Quaternion = (0.0, 0.0, 0.0, 1.0)
    for axis, angle in zip(order, (ai, aj, ak), strict=True):
        single = [0.0, 0.0, 0.0, math.cos(angle / 2.0)]
        single[axis] = math.sin(angle / 2.0)
        quaternion = quaternion_multiply(quaternion, single) if turning else quaternion_multiply(single, quaternion)
    return quaternion


def euler_matrix(ai: float, aj: float, ak: float, axes: Axes = "sxyz") -> Any:
    """Return the matrix (4, 4) of three rotations."""
    return quaternion_matrix(quaternion_from_euler(ai, aj, ak, axes))


def euler_from_quaternion(quaternion: Any, axes: Axes = "sxyz") -> tuple[float, float, float]:
    """Return the angles of a quaternion (x, y, z, w), by default roll, pitch and yaw."""
    return euler_from_matrix(quaternion_matrix(quaternion), axes)


def euler_from_matrix(matrix: Any, axes: Axes = "sxyz") -> tuple[float, float, float]:
    """Return the angles of the rotation in a matrix; where many are right, the last, or with `r` the first, is 0."""
    order, turning = _order(axes)
    i, j, k = order[::-1] if turning else order  # as if the axes stood still
    repeats = i == k
    k = 3 - i - j
    odd = (j - i) % 3 == 2
    m = np.asarray(matrix, dtype=np.float64)
    rest = math.hypot(m[i, j], m[i, k]) if repeats else math.hypot(m[i, i], m[j, i])
    middle = math.atan2(rest, m[i, i]) if repeats else math.atan2(-m[k, i], rest)
    if rest <= _EPSILON:  # first and last axis are the same line
        first, last = math.atan2(-m[j, k], m[j, j]), 0.0
    elif repeats:
        first, last = math.atan2(m[i, j], m[i, k]), math.atan2(m[j, i], -m[k, i])
    else:
        first, last = math.atan2(m[k, j], m[k, k]), math.atan2(m[j, i], m[i, i])
    if odd:
        first, middle, last = -first, -middle, -last
    return (last, middle, first) if turning else (first, middle, last)


def _order(axes: Axes) -> tuple[tuple[int, int, int], bool]:
    """Return the axes (0, 1, 2 for x, y, z) in the order of the angles, and whether they turn with the body."""
    if isinstance(axes, str):
        letters = axes.lower()
        numbers = tuple("xyz".find(letter) for letter in letters[1:])
        if letters[:1] not in ("s", "r") or len(numbers) != 3 or -1 in numbers:
            raise ValueError(f"axes are `s` or `r` and three of x, y, z, as in 'sxyz', not {axes!r}")
        first, second, third = numbers
        if second in (first, third):
            raise ValueError(f"an axis cannot follow itself, as in {axes!r}")
        return (first, second, third), letters[0] == "r"
    inner, odd, again, turning = axes
    second = (inner + (2 if odd else 1)) % 3
    static = (inner, second, inner if again else 3 - inner - second)
    return (static[::-1] if turning else static), bool(turning)
