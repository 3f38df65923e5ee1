"""Homogeneous matrices (4, 4) of translations, rotations, scalings and reflections, and the way back.

Source: https://github.com/DLu/tf_transformations
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from gz_course.sim.ros.tf_transformations.quaternions import Quaternion, quaternion_about_axis, random_quaternion
from gz_course.sim.ros.tf_transformations.vectors import unit_vector


def identity_matrix() -> Any:
    return np.identity(4)


def translation_matrix(direction: Any) -> Any:
    matrix = np.identity(4)
    matrix[:3, 3] = direction[:3]
    return matrix


def translation_from_matrix(matrix: Any) -> Any:
    return np.array(matrix, dtype=np.float64)[:3, 3]


def quaternion_matrix(quaternion: Any) -> Any:
    """Return the rotation of a quaternion (x, y, z, w) of any length; that of the length 0 is none."""
    x, y, z, w = map(float, quaternion)
    squared = x * x + y * y + z * z + w * w
    matrix = np.identity(4)
    if squared < np.finfo(float).eps:
        return matrix
    vector = np.array([x, y, z])
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    matrix[:3, :3] += 2.0 / squared * (w * cross + np.outer(vector, vector) - np.dot(vector, vector) * np.identity(3))
    return matrix


def quaternion_from_matrix(matrix: Any) -> Quaternion:
    """Return the quaternion (x, y, z, w), with w not negative, of the rotation in a matrix."""
    m = rotation_of(np.asarray(matrix, dtype=np.float64)[:3, :3])
    # The largest of the four is taken from the diagonal, because a small one would be inexact.
    squared = [1.0 + m[0, 0] - m[1, 1] - m[2, 2], 1.0 - m[0, 0] + m[1, 1] - m[2, 2]]
    squared += [1.0 - m[0, 0] - m[1, 1] + m[2, 2], 1.0 + m[0, 0] + m[1, 1] + m[2, 2]]
    rows = (
        (squared[0], m[0, 1] + m[1, 0], m[0, 2] + m[2, 0], m[2, 1] - m[1, 2]),
        (m[0, 1] + m[1, 0], squared[1], m[1, 2] + m[2, 1], m[0, 2] - m[2, 0]),
        (m[0, 2] + m[2, 0], m[1, 2] + m[2, 1], squared[2], m[1, 0] - m[0, 1]),
        (m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], squared[3]),
    )
    row = rows[int(np.argmax(squared))]
    length = math.copysign(math.sqrt(sum(number * number for number in row)), row[3])
    x, y, z, w = (float(number / length) for number in row)
    return x, y, z, w


def rotation_matrix(angle: float, direction: Any, point: Any = None) -> Any:
    """Return the rotation by an angle [rad] about an axis, which goes through the origin or through `point`."""
    matrix = quaternion_matrix(quaternion_about_axis(angle, direction))
    if point is not None:
        fixed = np.asarray(point[:3], dtype=np.float64)
        matrix[:3, 3] = fixed - matrix[:3, :3] @ fixed
    return matrix


def rotation_from_matrix(matrix: Any) -> tuple[float, Any, Any]:
    """Return angle [rad], axis and a point (4,) on the axis of a rotation about any axis."""
    matrix = np.asarray(matrix, dtype=np.float64)
    x, y, z, w = quaternion_from_matrix(matrix)
    sine = math.sqrt(x * x + y * y + z * z)
    direction = np.array([x, y, z]) / sine if sine > 0.0 else np.array([1.0, 0.0, 0.0])
    return 2.0 * math.atan2(sine, w), direction, fixed_point(matrix)


def random_rotation_matrix(rand: Any = None) -> Any:
    return quaternion_matrix(random_quaternion(rand))


def scale_matrix(factor: float, origin: Any = None, direction: Any = None) -> Any:
    """Return the scaling by a factor about a point, in all directions or in one."""
    matrix = np.identity(4)
    if direction is None:
        matrix[:3, :3] *= factor
    else:
        along = unit_vector(direction[:3])
        matrix[:3, :3] -= (1.0 - factor) * np.outer(along, along)
    if origin is not None:
        fixed = np.asarray(origin[:3], dtype=np.float64)
        matrix[:3, 3] = fixed - matrix[:3, :3] @ fixed
    return matrix


def scale_from_matrix(matrix: Any) -> tuple[float, Any, Any]:
    """Return factor, fixed point (4,) and direction, None for a scaling in all directions."""
    matrix = np.asarray(matrix, dtype=np.float64)
    trace = float(np.trace(matrix[:3, :3]))
    values, vectors = np.linalg.eigh((matrix[:3, :3] + matrix[:3, :3].T) / 2.0)
    nearest = int(np.argmin(abs(values - (trace - 2.0))))
    if abs(values[nearest] - (trace - 2.0)) < 1e-8:
        return trace - 2.0, fixed_point(matrix), vectors[:, nearest]
    return trace / 3.0, fixed_point(matrix), None


def reflection_matrix(point: Any, normal: Any) -> Any:
    """Return the reflection at the plane through a point with this normal."""
    across = unit_vector(normal[:3])
    matrix = np.identity(4)
    matrix[:3, :3] -= 2.0 * np.outer(across, across)
    matrix[:3, 3] = 2.0 * np.dot(np.asarray(point[:3], dtype=np.float64), across) * across
    return matrix


def reflection_from_matrix(matrix: Any) -> tuple[Any, Any]:
    """Return a point (4,) of the plane and its normal. Raises ValueError if the matrix is no reflection."""
    matrix = np.asarray(matrix, dtype=np.float64)
    values, vectors = np.linalg.eigh(matrix[:3, :3])
    if abs(values[0] + 1.0) > 1e-8:
        raise ValueError("no unit eigenvector corresponding to eigenvalue -1")
    return fixed_point(matrix), vectors[:, 0]


def inverse_matrix(matrix: Any) -> Any:
    return np.linalg.inv(matrix)


def concatenate_matrices(*matrices: Any) -> Any:
    """Return the product of matrices; the last one is applied first."""
    product = np.identity(4)
    for matrix in matrices:
        product = product @ np.asarray(matrix, dtype=np.float64)
    return product


def is_same_transform(matrix0: Any, matrix1: Any) -> bool:
    """Return whether two matrices do the same, but for a common factor."""
    one, two = (np.asarray(matrix, dtype=np.float64) for matrix in (matrix0, matrix1))
    return bool(np.allclose(one / one[3, 3], two / two[3, 3]))


def rotation_of(matrix: Any) -> Any:
    """Return the rotation in a matrix (3, 3) that may scale and shear as well."""
    turn, upper = np.linalg.qr(matrix)
    turn = turn * np.where(np.diag(upper) < 0.0, -1.0, 1.0)
    return turn if np.linalg.det(turn) > 0.0 else turn * (-1.0, 1.0, 1.0)


def fixed_point(matrix: Any) -> Any:
    """Return a point (4,) that a matrix does not move, the one nearest to the origin."""
    point, *_ = np.linalg.lstsq(np.identity(3) - matrix[:3, :3], matrix[:3, 3], rcond=1e-9)
    return np.append(point, 1.0)
