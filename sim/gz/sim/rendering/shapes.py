"""Intersects many rays at once with planes, boxes, ellipsoids, cylinders and capsules.

Every shape but the plane is convex, so that a ray is inside of it between two distances. All coordinates are in the
frame of the shape; a point or direction is three arrays x, y, z that broadcast against each other and against `size`,
MuJoCo's half sizes. Distances are in [m] for directions of length 1. For a ray that misses, `entry <= exit` is false:
the entry is behind the exit, or both are NaN. The caller silences NumPy's warnings about that.

Source: https://en.wikipedia.org/wiki/Slab_method
Source: https://mujoco.readthedocs.io/en/stable/XMLreference.html#body-geom-size (meaning of the sizes)
"""

from __future__ import annotations

from collections.abc import Callable

import mujoco
import numpy as np
from numpy.typing import NDArray

Values = NDArray[np.float32]
Triple = tuple[Values, Values, Values]
Faces = NDArray[np.int8]
Interval = tuple[Values, Values, Faces | int]
"""Entry and exit [m], and the face of the entry: 0 to 5 for -x +x -y +y -z +z, or ROUND."""

ROUND = 6
"""The face of a surface without a constant normal."""
_NOWHERE = np.float32(np.inf)
_TINY = np.float32(1e-30)
"""Added to what may be 0 before a division; too small to change anything else."""


def _slab(origin: Values, direction: Values, half: Values) -> tuple[Values, Values]:
    """Return where a ray enters and leaves the space between -half and half along one axis."""
    inverse = 1.0 / (direction + _TINY)
    middle = -origin * inverse
    width = half * np.abs(inverse)
    return middle - width, middle + width


def _plane(origin: Triple, direction: Triple, size: Triple) -> Interval:
    """Intersect with a rectangle in z = 0, which is visible from above only."""
    distance = -origin[2] / direction[2]
    inside = direction[2] < 0.0
    inside &= np.abs(origin[0] + distance * direction[0]) <= size[0]
    inside &= np.abs(origin[1] + distance * direction[1]) <= size[1]
    distance = np.where(inside, distance, _NOWHERE)
    return distance, distance, 5


def _box(origin: Triple, direction: Triple, size: Triple) -> Interval:
    x, out = _slab(origin[0], direction[0], size[0])
    y, out_y = _slab(origin[1], direction[1], size[1])
    z, out_z = _slab(origin[2], direction[2], size[2])
    first = np.maximum(x, y)
    face = (y > x).view(np.int8) * np.int8(2)
    np.copyto(face, np.int8(4), where=z > first)
    first = np.maximum(first, z)
    face += np.where(face == 0, direction[0] < 0.0, np.where(face == 2, direction[1] < 0.0, direction[2] < 0.0))
    np.minimum(out, out_y, out=out)
    np.minimum(out, out_z, out=out)
    return first, out, face


def _ellipsoid(origin: Triple, direction: Triple, size: Triple) -> Interval:
    ox, oy, oz = (o / s for o, s in zip(origin, size, strict=True))
    dx, dy, dz = (d / s for d, s in zip(direction, size, strict=True))
    # From the point of the ray that is next to the centre, so that nothing is lost to rounding far away.
    square = dx * dx + dy * dy + dz * dz
    shift = -(ox * dx + oy * dy + oz * dz) / square
    ox, oy, oz = ox + shift * dx, oy + shift * dy, oz + shift * dz
    half: Values = np.sqrt((1.0 - (ox * ox + oy * oy + oz * oz)) / square)
    return shift - half, shift + half, ROUND


def _tube(origin: Triple, direction: Triple, radius: Values) -> tuple[Values, Values]:
    """Return where a ray is within `radius` of the z axis."""
    ox, oy, dx, dy = origin[0], origin[1], direction[0], direction[1]
    square = dx * dx + dy * dy + _TINY
    shift = (-(ox * dx + oy * dy) / square).astype(np.float32, copy=False)
    ox, oy = ox + shift * dx, oy + shift * dy
    half = np.sqrt((radius * radius - (ox * ox + oy * oy)) / square).astype(np.float32, copy=False)
    return shift - half, shift + half


def _cylinder(origin: Triple, direction: Triple, size: Triple) -> Interval:
    side, out = _tube(origin, direction, size[0])
    cap, out_z = _slab(origin[2], direction[2], size[1])
    face = np.where(cap > side, np.where(direction[2] < 0.0, np.int8(5), np.int8(4)), np.int8(ROUND))
    return np.maximum(side, cap), np.minimum(out, out_z), face


def _capsule(origin: Triple, direction: Triple, size: Triple) -> Interval:
    first, last, _ = _cylinder(origin, direction, size)
    missed = ~(first <= last)
    first[missed] = last[missed] = np.nan
    radii = (size[0], size[0], size[0])
    for end in (size[1], -size[1]):
        near, far, _ = _ellipsoid((origin[0], origin[1], origin[2] - end), direction, radii)
        first, last = np.fmin(first, near), np.fmax(last, far)
    return first, last, ROUND


INTERVALS: dict[int, Callable[[Triple, Triple, Triple], Interval]] = {
    int(mujoco.mjtGeom.mjGEOM_PLANE): _plane,
    int(mujoco.mjtGeom.mjGEOM_BOX): _box,
    int(mujoco.mjtGeom.mjGEOM_SPHERE): _ellipsoid,
    int(mujoco.mjtGeom.mjGEOM_ELLIPSOID): _ellipsoid,
    int(mujoco.mjtGeom.mjGEOM_CYLINDER): _cylinder,
    int(mujoco.mjtGeom.mjGEOM_CAPSULE): _capsule,
}
"""The function for each kind of MuJoCo geom that is no mesh and no heightmap."""


def normals(kind: int, point: Triple, size: Triple) -> Triple:
    """Return outward directions (not of length 1) of the surface of a shape at points of it."""
    x, y, z = point
    geom = mujoco.mjtGeom
    if kind in (geom.mjGEOM_SPHERE, geom.mjGEOM_ELLIPSOID):
        return x / size[0] ** 2, y / size[1] ** 2, z / size[2] ** 2
    zero = np.zeros_like(x)
    if kind == geom.mjGEOM_CAPSULE:
        return x, y, z - np.clip(z, -size[1], size[1])
    if kind == geom.mjGEOM_CYLINDER:
        cap = np.abs(z) / size[1] > np.hypot(x, y) / size[0]
        return np.where(cap, zero, x), np.where(cap, zero, y), np.where(cap, z, zero)
    if kind == geom.mjGEOM_BOX:
        depth = [np.abs(p) / s for p, s in zip(point, size, strict=True)]
        most = np.maximum(np.maximum(*depth[:2]), depth[2])
        return (
            np.where(depth[0] == most, x, zero),
            np.where((depth[1] == most) & (depth[0] < most), y, zero),
            np.where(depth[2] > np.maximum(*depth[:2]), z, zero),
        )
    return zero, zero, np.ones_like(z)
