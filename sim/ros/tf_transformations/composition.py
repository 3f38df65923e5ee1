"""Homogeneous matrices (4, 4) made of scaling, shear, rotation and translation, and what a matrix is made of.

Source: https://github.com/DLu/tf_transformations and https://github.com/matthew-brett/transforms3d
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from gz_course.sim.ros.tf_transformations.euler_angles import euler_from_matrix, euler_matrix
from gz_course.sim.ros.tf_transformations.matrices import fixed_point, rotation_of
from gz_course.sim.ros.tf_transformations.vectors import unit_vector

_SMALL = 1e-8


def compose_matrix(
    scale: Any = None, shear: Any = None, angles: Any = None, translate: Any = None, perspective: Any = None
) -> Any:
    """Return the matrix that shears (x-y, x-z, y-z), then scales, then turns (roll, pitch, yaw), then moves.

    `perspective` changes nothing, as in the package.
    """
    matrix = np.identity(4) if angles is None else euler_matrix(*angles)
    if scale is not None:
        matrix[:3, :3] *= np.asarray(scale, dtype=np.float64)
    if shear is not None:
        upper = np.identity(3)
        upper[0, 1], upper[0, 2], upper[1, 2] = shear
        matrix[:3, :3] = matrix[:3, :3] @ upper
    if translate is not None:
        matrix[:3, 3] = translate[:3]
    return matrix


def decompose_matrix(matrix: Any) -> tuple[Any, Any, tuple[float, float, float], Any, None]:
    """Return scale, shear, angles and translation of a matrix, as `compose_matrix` takes them; perspective is None."""
    matrix = np.asarray(matrix, dtype=np.float64)
    if abs(np.linalg.det(matrix[:3, :3])) == 0.0:
        raise ValueError("the matrix is degenerate: it takes everything to a plane")
    turn = rotation_of(matrix[:3, :3])
    upper = turn.T @ matrix[:3, :3]
    scale = np.diag(upper)
    shear = np.array([upper[0, 1] / scale[0], upper[0, 2] / scale[0], upper[1, 2] / scale[1]])
    return scale, shear, euler_from_matrix(turn), matrix[:3, 3], None


def shear_matrix(angle: float, direction: Any, point: Any, normal: Any) -> Any:
    """Return the shear by an angle [rad] along a direction in the plane through a point with this normal."""
    along, across = unit_vector(direction[:3]), unit_vector(normal[:3])
    if abs(np.dot(along, across)) > 1e-6:
        raise ValueError("direction and normal vectors are not orthogonal")
    matrix = np.identity(4)
    matrix[:3, :3] += math.tan(angle) * np.outer(along, across)
    matrix[:3, 3] = -math.tan(angle) * np.dot(np.asarray(point[:3], dtype=np.float64), across) * along
    return matrix


def shear_from_matrix(matrix: Any) -> tuple[float, Any, Any, Any]:
    """Return angle, direction, point and normal of a shear. Raises ValueError if the matrix is no shear."""
    matrix = np.asarray(matrix, dtype=np.float64)
    along, sizes, across = np.linalg.svd(matrix[:3, :3] - np.identity(3))
    if sizes[1] > _SMALL or abs(sizes[0] * np.dot(along[:, 0], across[0])) > _SMALL:
        raise ValueError("no two linear independent eigenvectors found")
    return math.atan(sizes[0]), along[:, 0], fixed_point(matrix), across[0]


def orthogonalization_matrix(lengths: Any, angles: Any) -> Any:
    """Return the matrix from the axes of a crystal's cell, with these lengths and angles [deg], to orthogonal ones."""
    a, b, c = lengths
    alpha, beta, gamma = np.radians(angles)
    cosine = (math.cos(alpha) * math.cos(beta) - math.cos(gamma)) / (math.sin(alpha) * math.sin(beta))
    matrix = np.identity(4)
    matrix[:3, 0] = a * np.array(
        [math.sin(beta) * math.sqrt(1.0 - cosine * cosine), -math.sin(beta) * cosine, math.cos(beta)]
    )
    matrix[:3, 1] = 0.0, b * math.sin(alpha), b * math.cos(alpha)
    matrix[:3, 2] = 0.0, 0.0, c
    return matrix


def superimposition_matrix(v0: Any, v1: Any, scaling: bool = False, usesvd: bool = True) -> Any:
    """Return the motion that takes vectors (3, n) or (4, n) best to others: the sum of squared distances is least.

    `usesvd` changes nothing but the way to the same result in the package.

    Source: W. Kabsch, A solution for the best rotation to relate two sets of vectors, 1976
    """
    one, two = (np.asarray(vectors, dtype=np.float64)[:3] for vectors in (v0, v1))
    if one.shape != two.shape or one.shape[1] < 3:
        raise ValueError("Vector sets are of wrong shape or type.")
    start, end = one.mean(axis=1), two.mean(axis=1)
    one, two = one - start[:, None], two - end[:, None]
    left, _, right = np.linalg.svd(two @ one.T)
    turn = left @ np.diag((1.0, 1.0, math.copysign(1.0, np.linalg.det(left @ right)))) @ right
    if scaling:
        turn *= math.sqrt(np.sum(two * two) / np.sum(one * one))
    matrix = np.identity(4)
    matrix[:3, :3] = turn
    matrix[:3, 3] = end - turn @ start
    return matrix
