"""Quaternions in the order x, y, z, w: products, inverses, interpolation, and rotations about an axis.

Source: https://github.com/DLu/tf_transformations
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from gz_course.sim.ros.tf_transformations.vectors import unit_vector

_EPSILON = 4.0 * float(np.finfo(float).eps)

Quaternion = tuple[float, float, float, float]


def quaternion_multiply(quaternion1: Any, quaternion0: Any) -> Quaternion:
    """Return the product: first the rotation `quaternion0`, then `quaternion1`."""
    x1, y1, z1, w1 = map(float, quaternion1)
    x0, y0, z0, w0 = map(float, quaternion0)
    return (
        w1 * x0 + x1 * w0 + y1 * z0 - z1 * y0,
        w1 * y0 + y1 * w0 + z1 * x0 - x1 * z0,
        w1 * z0 + z1 * w0 + x1 * y0 - y1 * x0,
        w1 * w0 - x1 * x0 - y1 * y0 - z1 * z0,
    )


def quaternion_conjugate(quaternion: Any) -> Any:
    """Return an array of the quaternion with its vector reversed."""
    return np.asarray(quaternion, dtype=np.float64) * (-1.0, -1.0, -1.0, 1.0)


def quaternion_inverse(quaternion: Any) -> Any:
    """Return an array of the quaternion whose product with this one is 0, 0, 0, 1."""
    return quaternion_conjugate(quaternion) / np.dot(quaternion, quaternion)


def quaternion_about_axis(angle: float, axis: Any) -> Quaternion:
    """Return the rotation by an angle [rad] about an axis, whose length does not matter."""
    x, y, z = (float(part) * math.sin(angle / 2.0) for part in unit_vector(axis[:3]))
    return x, y, z, math.cos(angle / 2.0)


def quaternion_slerp(quat0: Any, quat1: Any, fraction: float, spin: int = 0, shortestpath: bool = True) -> Any:
    """Return an array of the rotation at `fraction` of the way from one to the other, with `spin` more half turns."""
    start, end = unit_vector(quat0[:4]), unit_vector(quat1[:4])
    if fraction == 0.0:
        return start
    if fraction == 1.0:
        return end
    dot = float(np.dot(start, end))
    if abs(abs(dot) - 1.0) < _EPSILON:
        return start
    if shortestpath and dot < 0.0:
        dot, end = -dot, -end
    angle = math.acos(dot) + spin * math.pi
    if abs(angle) < _EPSILON:
        return start
    return (start * math.sin((1.0 - fraction) * angle) + end * math.sin(fraction * angle)) / math.sin(angle)


def random_quaternion(rand: Any = None) -> Any:
    """Return an array of a unit quaternion; all rotations are equally likely if `rand` are three numbers of 0 to 1.

    Source: K. Shoemake, Uniform random rotations, in Graphics Gems III
    """
    share, first, second = np.random.rand(3) if rand is None else rand
    inner, outer = math.sqrt(1.0 - share), math.sqrt(share)
    first, second = 2.0 * math.pi * first, 2.0 * math.pi * second
    return np.array(
        [math.sin(first) * inner, math.cos(first) * inner, math.sin(second) * outer, math.cos(second) * outer]
    )
