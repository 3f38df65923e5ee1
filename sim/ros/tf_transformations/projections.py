"""Homogeneous matrices (4, 4) that project onto a plane, or clip a view, and the way back.

Source: https://github.com/DLu/tf_transformations
"""

from __future__ import annotations

from typing import Any

import numpy as np

from gz_course.sim.ros.tf_transformations.matrices import fixed_point
from gz_course.sim.ros.tf_transformations.vectors import unit_vector

_SMALL = 1e-8


def projection_matrix(
    point: Any, normal: Any, direction: Any = None, perspective: Any = None, pseudo: bool = False
) -> Any:
    """Return the projection onto the plane through `point` with this normal.

    It is orthogonal, or along `direction`, or as seen from the point `perspective`; with `pseudo`, the order of depths
    behind one another is kept.
    """
    across, place = unit_vector(normal[:3]), np.asarray(point[:3], dtype=np.float64)
    matrix = np.identity(4)
    if perspective is None:
        along = across if direction is None else np.asarray(direction[:3], dtype=np.float64)
        scale = np.dot(along, across)
        matrix[:3, :3] -= np.outer(along, across) / scale
        matrix[:3, 3] = along * np.dot(place, across) / scale
        return matrix
    eye = np.asarray(perspective[:3], dtype=np.float64)
    matrix[:3, :3] *= np.dot(eye - place, across)
    matrix[:3, :3] -= np.outer(eye + across if pseudo else eye, across)
    matrix[:3, 3] = np.dot(place, across) * (eye + across if pseudo else eye)
    matrix[3, :3] = -across
    matrix[3, 3] = np.dot(eye, across)
    return matrix


def projection_from_matrix(matrix: Any, pseudo: bool = False) -> tuple[Any, Any, Any, Any, bool]:
    """Return the arguments of `projection_matrix`. Raises ValueError if the matrix is no projection."""
    matrix = np.asarray(matrix, dtype=np.float64)
    scale = float(np.linalg.norm(matrix[3, :3]))
    if scale < _SMALL:
        matrix = matrix / matrix[3, 3]
        lost, sizes, normals = np.linalg.svd(np.identity(3) - matrix[:3, :3])
        if sizes[1] > _SMALL or abs(sizes[0] * np.dot(lost[:, 0], normals[0]) - 1.0) > _SMALL:
            raise ValueError("no eigenvector corresponding to eigenvalue 0")
        is_orthogonal = abs(np.dot(lost[:, 0], normals[0])) > 1.0 - _SMALL
        return fixed_point(matrix), normals[0], None if is_orthogonal else lost[:, 0], None, False
    matrix = matrix / scale
    across = -matrix[3, :3]
    inside = np.cross(across, np.identity(3)[int(np.argmin(abs(across)))])
    distance = np.dot(inside, matrix[:3, :3] @ inside) / np.dot(inside, inside)
    eye = distance * across - matrix[:3, :3] @ across - (across if pseudo else 0.0)
    point = np.append(across * (np.dot(eye, across) - distance), 1.0)
    return point, across, None, eye, pseudo


def clip_matrix(
    left: float, right: float, bottom: float, top: float, near: float, far: float, perspective: bool = False
) -> Any:
    """Return the matrix that takes a box, or with `perspective` a truncated pyramid, to coordinates from -1 to 1."""
    if left >= right or bottom >= top or near >= far:
        raise ValueError("invalid frustum: left, bottom and near must be less than right, top and far")
    if perspective and near <= 0.0:
        raise ValueError("invalid frustum: near <= 0")
    low, high = np.array([left, bottom, near]), np.array([right, top, far])
    size = high - low
    matrix = np.zeros((4, 4))
    if perspective:
        matrix[0, 0], matrix[1, 1], matrix[2, 2] = -2.0 * near / size[0], -2.0 * near / size[1], -(far + near) / size[2]
        matrix[0, 2], matrix[1, 2] = (high + low)[:2] / size[:2]
        matrix[2, 3], matrix[3, 2] = 2.0 * near * far / size[2], -1.0
        return matrix
    matrix[:3, :3] = np.diag(2.0 / size)
    matrix[:3, 3] = -(high + low) / size
    matrix[3, 3] = 1.0
    return matrix
