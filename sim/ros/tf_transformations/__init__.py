"""Quaternions (x, y, z, w), Euler angles [rad] and homogeneous matrices (4, 4), in place of `tf_transformations`.

As the package itself, this leaves the computing to `transforms3d`, whose quaternions are (w, x, y, z).

Source: https://github.com/DLu/tf_transformations
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import wraps
from typing import Any

import numpy as np
from transforms3d import _gohlketransforms as matrices
from transforms3d import affines, euler, quaternions

__all__ = [
    "Arcball",
    "arcball_constrain_to_axis",
    "arcball_map_to_sphere",
    "arcball_nearest_axis",
    "clip_matrix",
    "compose_matrix",
    "concatenate_matrices",
    "decompose_matrix",
    "euler_from_matrix",
    "euler_from_quaternion",
    "euler_matrix",
    "identity_matrix",
    "inverse_matrix",
    "is_same_transform",
    "orthogonalization_matrix",
    "projection_from_matrix",
    "projection_matrix",
    "quaternion_about_axis",
    "quaternion_conjugate",
    "quaternion_from_euler",
    "quaternion_from_matrix",
    "quaternion_inverse",
    "quaternion_matrix",
    "quaternion_multiply",
    "quaternion_slerp",
    "random_quaternion",
    "random_rotation_matrix",
    "random_vector",
    "reflection_from_matrix",
    "reflection_matrix",
    "rotation_from_matrix",
    "rotation_matrix",
    "scale_from_matrix",
    "scale_matrix",
    "shear_from_matrix",
    "shear_matrix",
    "superimposition_matrix",
    "translation_from_matrix",
    "translation_matrix",
    "unit_vector",
    "vector_norm",
]

Axes = str | tuple[int, int, int, int]
Quaternion = tuple[float, float, float, float]


def _with_arrays(function: Callable[..., Any]) -> Callable[..., Any]:
    """Give a function arrays where its caller gives lists or whole numbers, which it takes with NumPy 1 only."""

    @wraps(function)
    def call(*arguments: Any, **named: Any) -> Any:
        return function(*map(_array, arguments), **{name: _array(value) for name, value in named.items()})

    return call


def _array(value: Any) -> Any:
    return np.asarray(value, dtype=np.float64) if isinstance(value, list | tuple | np.ndarray) else value


arcball_constrain_to_axis = _with_arrays(matrices.arcball_constrain_to_axis)
arcball_map_to_sphere = _with_arrays(matrices.arcball_map_to_sphere)
arcball_nearest_axis = _with_arrays(matrices.arcball_nearest_axis)
clip_matrix = _with_arrays(matrices.clip_matrix)
concatenate_matrices = _with_arrays(matrices.concatenate_matrices)
identity_matrix = _with_arrays(matrices.identity_matrix)
inverse_matrix = _with_arrays(matrices.inverse_matrix)
is_same_transform = _with_arrays(matrices.is_same_transform)
orthogonalization_matrix = _with_arrays(matrices.orthogonalization_matrix)
projection_from_matrix = _with_arrays(matrices.projection_from_matrix)
projection_matrix = _with_arrays(matrices.projection_matrix)
random_vector = _with_arrays(matrices.random_vector)
reflection_from_matrix = _with_arrays(matrices.reflection_from_matrix)
reflection_matrix = _with_arrays(matrices.reflection_matrix)
rotation_from_matrix = _with_arrays(matrices.rotation_from_matrix)
rotation_matrix = _with_arrays(matrices.rotation_matrix)
scale_from_matrix = _with_arrays(matrices.scale_from_matrix)
scale_matrix = _with_arrays(matrices.scale_matrix)
shear_matrix = _with_arrays(matrices.shear_matrix)
translation_from_matrix = _with_arrays(matrices.translation_from_matrix)
translation_matrix = _with_arrays(matrices.translation_matrix)
unit_vector = matrices.unit_vector
vector_norm = matrices.vector_norm


def quaternion_multiply(quaternion1: Any, quaternion0: Any) -> Quaternion:
    """Return the product: first the rotation `quaternion0`, then `quaternion1`."""
    return _w_last(quaternions.qmult(_w_first(quaternion1), _w_first(quaternion0)))


def quaternion_conjugate(quaternion: Any) -> Any:
    """Return an array of the quaternion with its vector reversed."""
    return np.array(_w_last(quaternions.qconjugate(_w_first(quaternion))))


def quaternion_inverse(quaternion: Any) -> Any:
    """Return an array of the quaternion whose product with this one is 0, 0, 0, 1."""
    return np.array(_w_last(matrices.quaternion_inverse(np.array(_w_first(quaternion)))))


def quaternion_about_axis(angle: float, axis: Any) -> Quaternion:
    """Return the rotation by an angle [rad] about an axis, whose length does not matter."""
    return _w_last(quaternions.axangle2quat(axis[:3], angle))


def quaternion_slerp(quat0: Any, quat1: Any, fraction: float, spin: int = 0, shortestpath: bool = True) -> Any:
    """Return an array of the rotation at `fraction` of the way from one to the other, with `spin` more half turns."""
    return matrices.quaternion_slerp(
        quat0[:4], quat1[:4], fraction, spin, shortestpath
    )  # the order of the parts is all one


def random_quaternion(rand: Any = None) -> Any:
    """Return an array of a unit quaternion; all rotations are equally likely if `rand` are three numbers of 0 to 1."""
    return np.array(_w_last(matrices.random_quaternion(rand)))


def random_rotation_matrix(rand: Any = None) -> Any:
    """Return the matrix of `random_quaternion`."""
    return quaternion_matrix(random_quaternion(rand))


def quaternion_matrix(quaternion: Any) -> Any:
    """Return the rotation of a quaternion of any length; that of the length 0 is none."""
    return _affine(quaternions.quat2mat(_w_first(quaternion)))


def quaternion_from_matrix(matrix: Any) -> Quaternion:
    """Return the quaternion, with w not negative, of the rotation in a matrix that may scale and shear as well."""
    return _w_last(quaternions.mat2quat(affines.decompose(matrix)[1]))


def quaternion_from_euler(ai: float, aj: float, ak: float, axes: Axes = "sxyz") -> Quaternion:
    """Return the quaternion of three rotations, by default roll, pitch and yaw.

    `axes` is a text: `s` for axes that stand still or `r` for axes that turn with the body, then the axes in their
    order; or the four numbers (first axis, odd, first axis again, turning). Raises ValueError for any other.
    """
    return _w_last(euler.euler2quat(ai, aj, ak, _known(axes)))


def euler_from_quaternion(quaternion: Any, axes: Axes = "sxyz") -> tuple[float, float, float]:
    """Return the angles of a quaternion, by default roll, pitch and yaw; `axes` as in `quaternion_from_euler`."""
    first, second, third = euler.quat2euler(_w_first(quaternion), _known(axes))
    return float(first), float(second), float(third)


def euler_matrix(ai: float, aj: float, ak: float, axes: Axes = "sxyz") -> Any:
    """Return the matrix of three rotations; `axes` as in `quaternion_from_euler`."""
    return _affine(euler.euler2mat(ai, aj, ak, _known(axes)))


def euler_from_matrix(matrix: Any, axes: Axes = "sxyz") -> tuple[float, float, float]:
    """Return the angles of the rotation in a matrix; `axes` as in `quaternion_from_euler`."""
    first, second, third = euler.mat2euler(matrix, _known(axes))
    return float(first), float(second), float(third)


def compose_matrix(
    scale: Any = None, shear: Any = None, angles: Any = None, translate: Any = None, perspective: Any = None
) -> Any:
    """Return the matrix that shears (x-y, x-z, y-z), then scales, then turns (roll, pitch, yaw), then moves.

    `perspective` changes nothing, as in the package.
    """
    turn = np.identity(3) if angles is None else euler.euler2mat(*angles)
    place, size = np.zeros(3) if translate is None else translate[:3], np.ones(3) if scale is None else scale
    return affines.compose(place, turn, size, shear)


def decompose_matrix(matrix: Any) -> tuple[Any, Any, tuple[float, float, float], Any, None]:
    """Return scale, shear, angles and translation of a matrix, as `compose_matrix` takes them; perspective is None.

    Raises ValueError for a matrix that makes a space flat.
    """
    try:
        place, turn, size, shear = affines.decompose(np.asarray(matrix, dtype=np.float64))
    except np.linalg.LinAlgError:
        raise ValueError("the matrix is degenerate") from None
    return size, shear, euler_from_matrix(turn), place, None


def shear_from_matrix(matrix: Any) -> tuple[float, Any, Any, Any]:
    """Return angle, direction, point and normal of a shear. Raises ValueError if the matrix is no shear.

    That of transforms3d 0.4.2 can be wrong by 0.01 rad: it asks for eigenvectors where there are too few.
    """
    matrix = np.asarray(matrix, dtype=np.float64)
    along, sizes, across = np.linalg.svd(matrix[:3, :3] - np.identity(3))
    if sizes[1] > 1e-8 or abs(sizes[0] * np.dot(along[:, 0], across[0])) > 1e-8:
        raise ValueError("no two linear independent eigenvectors found")
    return math.atan(sizes[0]), along[:, 0], _fixed_point(matrix), across[0]


def superimposition_matrix(v0: Any, v1: Any, scaling: bool = False, usesvd: bool = True) -> Any:
    """Return the motion that takes vectors (3, n) or (4, n) best to others: the sum of squared distances is least.

    Raises ValueError for vectors of other shapes.
    """
    one, two = (np.asarray(vectors, dtype=np.float64)[:3] for vectors in (v0, v1))
    return matrices.superimposition_matrix(one, two, scaling, usesvd)


class Arcball(matrices.Arcball):
    """A ball that is turned with the mouse. `initial` is a matrix or a quaternion (x, y, z, w)."""

    def __init__(self, initial: Any = None) -> None:
        """Start with a rotation; without one, with none."""
        super().__init__(_w_first(initial) if np.shape(initial) == (4,) else initial)


def _w_first(quaternion: Any) -> tuple[float, float, float, float]:
    x, y, z, w = map(float, quaternion)
    return w, x, y, z


def _w_last(quaternion: Any) -> Quaternion:
    w, x, y, z = map(float, quaternion)
    return x, y, z, w


def _affine(rotation: Any) -> Any:
    matrix = np.identity(4)
    matrix[:3, :3] = rotation
    return matrix


def _known(axes: Axes) -> Axes:
    """Return a sequence of axes if it is one. Raises ValueError with a sentence otherwise."""
    if not isinstance(axes, str):
        return axes
    if len(axes) != 4 or axes[0].lower() not in "sr" or not {*axes[1:].lower()} <= {*"xyz"}:
        raise ValueError(f"axes are `s` or `r` and three of x, y, z, as in 'sxyz', not {axes!r}")
    if axes[2] in (axes[1], axes[3]):
        raise ValueError(f"an axis cannot follow itself, as in {axes!r}")
    return axes.lower()


def _fixed_point(matrix: Any) -> Any:
    """Return a point (4,) that a matrix does not move, the one nearest to the origin."""
    point, *_ = np.linalg.lstsq(np.identity(3) - matrix[:3, :3], matrix[:3, 3], rcond=1e-9)
    return np.append(point, 1.0)
