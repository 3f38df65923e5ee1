"""Points that span a MuJoCo geom, in its own frame: the boxes of bounding box cameras enclose them.

A round shape has points on its surface, dense enough for an error of half a percent; a plane has its four corners.
"""

from __future__ import annotations

import math

import mujoco
import numpy as np

from gz_course.sim.gz.sim.rendering.viewpoint import Floats

_AROUND = 32
_RINGS = 17


def corners_of(half: Floats) -> Floats:
    """Return the corners (8, 3) of a box with these half edges."""
    signs = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    corners: Floats = signs * half
    return corners


def outline_of(model: mujoco.MjModel, geom: int) -> Floats:
    """Return points (n, 3) [m] whose extent is that of a geom."""
    kind, size = int(model.geom_type[geom]), model.geom_size[geom]
    types = mujoco.mjtGeom
    if kind == types.mjGEOM_SPHERE:
        return _ball() * size[0]
    if kind == types.mjGEOM_ELLIPSOID:
        return _ball() * size
    if kind == types.mjGEOM_CAPSULE:
        ball = _ball() * size[0]
        ends: Floats = np.concatenate((ball + np.array((0.0, 0.0, size[1])), ball - np.array((0.0, 0.0, size[1]))))
        return ends
    if kind == types.mjGEOM_CYLINDER:
        turns = np.linspace(0.0, 2.0 * math.pi, 2 * _AROUND, endpoint=False)
        ring = np.stack((size[0] * np.cos(turns), size[0] * np.sin(turns), np.full(len(turns), size[1])), axis=1)
        return np.concatenate((ring, ring * (1.0, 1.0, -1.0)))
    if kind == types.mjGEOM_MESH:
        mesh = int(model.geom_dataid[geom])
        first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
        return model.mesh_vert[first : first + count].astype(np.float64)
    if kind == types.mjGEOM_PLANE:
        return corners_of(np.array((size[0], size[1], 0.0)))
    if kind == types.mjGEOM_HFIELD:
        x, y, top, bottom = model.hfield_size[int(model.geom_dataid[geom])]
        return corners_of(np.array((x, y, (top + bottom) / 2.0))) + np.array((0.0, 0.0, (top - bottom) / 2.0))
    return corners_of(size)


def _ball() -> Floats:
    """Return points (n, 3) of the unit sphere, with those on its axes."""
    tilt = np.linspace(-math.pi / 2.0, math.pi / 2.0, _RINGS)
    turn = np.linspace(0.0, 2.0 * math.pi, _AROUND, endpoint=False)
    across = np.cos(tilt)[:, None]
    height = np.repeat(np.sin(tilt)[:, None], _AROUND, axis=1)
    return np.stack((across * np.cos(turn), across * np.sin(turn), height), axis=2).reshape(-1, 3)
