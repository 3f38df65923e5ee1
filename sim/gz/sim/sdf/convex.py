"""Convex pieces of a surface of triangles; MuJoCo collides convex meshes only.

Called for `<mesh>` collisions, whose pieces go to `gz.sim.physics.geoms`. A surface is split into its connected parts;
a convex part is one piece. A concave part that moves becomes its convex hull; one that never moves (the walls of a
house) becomes one thin wedge per triangle, so that it stays hollow.
Source: MuJoCo, Collision detection, https://mujoco.readthedocs.io/en/stable/computation/index.html#collision-detection
"""

from __future__ import annotations

import math

import mujoco
import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Triangles = NDArray[np.int32]

MOST_MOVING_PIECES = 32
MOST_STATIC_PIECES = 4000
WEDGE = 0.01
"""Thickness [m] of the wedge behind a triangle of a hollow surface."""
SHEET = 0.001
"""Thickness [m] of a flat part."""
_CONCAVE = 0.02  # minimum height of a bump of a concave part, relative to its size
_HOLE = 1e-3  # minimum area of the holes of an open surface, relative to its area
_SAMPLES = 1000  # maximum number of triangles and of points checked for bumps


def convex_pieces(vertices: Points, triangles: Triangles, *, moving: bool) -> tuple[tuple[Points, ...], float]:
    """Return the points (k, 3) [m] of each convex piece, and the relative excess of the hulls over the surface's
    volume.

    The excess is 0 if no part became its hull and inf if the surface is open and has no volume. `vertices` is (n, 3)
    [m], `triangles` (m, 3). A surface without extent has no pieces.
    """
    vertices, triangles = _welded(vertices, triangles)
    if not len(triangles):
        return (), 0.0
    parts = _components(len(vertices), triangles)
    concave = [_is_concave(vertices, part, moving=moving) for part in parts]
    filled = [part for part, hollow in zip(parts, concave, strict=True) if hollow]
    wedges = sum(len(part) if hollow else 1 for part, hollow in zip(parts, concave, strict=True))
    if moving or wedges > MOST_STATIC_PIECES:
        if len(parts) > (MOST_MOVING_PIECES if moving else MOST_STATIC_PIECES):
            parts = filled = [triangles]
        return _solids([vertices[np.unique(part)] for part in parts]), _excess(vertices, filled)
    pieces: list[Points] = []
    for part, hollow in zip(parts, concave, strict=True):
        pieces.extend(_wedges(vertices, part) if hollow else [vertices[np.unique(part)]])
    return _solids(pieces), 0.0


def _welded(vertices: Points, triangles: Triangles) -> tuple[Points, Triangles]:
    """Merge vertices at the same position; drop triangles without area."""
    extent = float(np.max(np.ptp(vertices, axis=0))) if len(vertices) else 0.0
    if extent <= 0.0:
        return vertices, triangles[:0]
    cells = np.round((vertices - vertices.min(axis=0)) / (extent * 1e-7)).astype(np.int64)
    _, first, place = np.unique(cells, axis=0, return_index=True, return_inverse=True)
    welded, joined = vertices[first], place.reshape(-1)[triangles]
    a, b, c = (welded[joined[:, k]] for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return welded, joined[area > (extent * 1e-7) ** 2].astype(np.int32)


def _components(count: int, triangles: Triangles) -> list[Triangles]:
    """Return the triangles of each connected part, in the order of their first vertices."""
    label = np.arange(count)
    while True:
        lowest = label[triangles].min(axis=1)
        spread = label.copy()
        for corner in range(3):
            np.minimum.at(spread, triangles[:, corner], lowest)
        spread = spread[spread]
        if np.array_equal(spread, label):
            break
        label = spread
    own = label[triangles[:, 0]]
    order = np.argsort(own, kind="stable")
    cuts = np.flatnonzero(np.diff(own[order])) + 1
    return np.split(triangles[order], cuts)


def _is_concave(vertices: Points, triangles: Triangles, *, moving: bool) -> bool:
    """Return whether points of the part lie clearly above the plane of one of its triangles.

    A moving surface is a solid whichever way its normals point; a static one with inward normals is a room.
    """
    corners = np.unique(triangles)
    points = vertices[corners[:: 1 + len(corners) // _SAMPLES]]
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    inside_out = moving and _volume(a, b, c) < 0.0
    step = 1 + len(triangles) // _SAMPLES
    a, b, c = a[::step], b[::step], c[::step]
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True) * (-1.0 if inside_out else 1.0)
    heights = normals @ points.T - np.einsum("ij,ij->i", normals, a)[:, None]
    return bool(np.max(heights) > _CONCAVE * np.max(np.ptp(vertices[corners], axis=0)))


def _excess(vertices: Points, filled: list[Triangles]) -> float:
    """Return the relative excess of the hulls over the volume of these surfaces; inf if a surface is open."""
    own = hull = 0.0
    for triangles in filled:
        a, b, c = (vertices[triangles[:, k]] for k in range(3))
        if not _is_closed(a, b, c):
            return math.inf
        own += abs(_volume(a, b, c))
        hull += _hull_volume(vertices[np.unique(triangles)])
    return max(0.0, hull / own - 1.0) if own > 0.0 else math.inf if filled else 0.0


def _is_closed(a: Points, b: Points, c: Points) -> bool:
    """Return whether the area vectors of the triangles sum to zero, as those of a closed surface do."""
    areas = np.cross(b - a, c - a)
    return bool(np.linalg.norm(areas.sum(axis=0)) < _HOLE * np.linalg.norm(areas, axis=1).sum())


def _hull_volume(points: Points) -> float:
    """Return the volume [m^3] of the convex hull, computed by MuJoCo; 0 for points in a plane."""
    size = float(np.max(np.ptp(points, axis=0)))
    spec = mujoco.MjSpec()
    mesh = spec.add_mesh(name="hull", uservert=((points - points.mean(axis=0)) / size).ravel())
    mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX
    body = spec.worldbody.add_body()
    body.add_freejoint()
    body.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname="hull", density=1.0)
    try:
        return float(spec.compile().body_mass[1]) * size**3
    except ValueError:
        return 0.0


def _volume(a: Points, b: Points, c: Points) -> float:
    """Return the volume [m^3] inside triangles whose normals point outwards, negative if they point inwards.

    Source: divergence theorem, https://en.wikipedia.org/wiki/Polyhedron#Volume
    """
    middle = a.mean(axis=0)
    return float(np.einsum("ij,ij->", a - middle, np.cross(b - middle, c - middle))) / 6.0


def _wedges(vertices: Points, triangles: Triangles) -> list[Points]:
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    behind = WEDGE * normals
    return list(np.stack((a, b, c, a - behind, b - behind, c - behind), axis=1))


def _solids(pieces: list[Points]) -> tuple[Points, ...]:
    """Return the pieces, with a thickness for flat ones and without those that have no area."""
    made: list[Points] = []
    for points in pieces:
        centred = points - points.mean(axis=0)
        _, axes = np.linalg.eigh(centred.T @ centred)
        extents = np.ptp(centred @ axes, axis=0)
        if extents[1] <= 1e-6 * extents[2] or extents[2] <= 0.0:
            continue
        if extents[0] <= 1e-5 * extents[2]:
            shift = 0.5 * max(SHEET, 1e-4 * float(extents[2])) * axes[:, 0]
            points = np.concatenate((points - shift, points + shift))
        made.append(points)
    return tuple(made)
