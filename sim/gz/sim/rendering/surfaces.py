"""The visible shapes of a world in the frame of a camera at one moment, and which bundles of rays may meet them.

Meshes and heightmaps are left to MuJoCo's ray casting, which has trees of their triangles; `shapes` intersects all
others.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import ClassVar, NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.physics.builder import SITE_GROUP, VISUAL_GROUP
from gz_course.sim.gz.sim.rendering.shapes import INTERVALS
from gz_course.sim.gz.sim.rendering.viewpoint import Floats

Indices = NDArray[np.intp]
GROUP = 4
"""How many bundles after each other are looked at together first."""
_MOST_TESTED = 1 << 20
"""Bundles times shapes that are compared at once; limits the memory."""


class Bundles(NamedTuple):
    """Bundles of rays: those of bundle `i` are within `radius[i] + spread[i] * s` [m] of `start[i] + s * way[i]`, for s
    from 0 to `reach[i]` [m].
    """

    start: Floats
    way: Floats
    radius: Floats
    spread: Floats
    reach: Floats


class Surfaces:
    """The geoms `ids` of MuJoCo's model, seen from `origin` (3,) with the camera's `axes` (3, 3) as columns."""

    GROUPS: ClassVar = np.array([group == VISUAL_GROUP for group in range(6)], dtype=np.uint8)
    """The geom groups that are visible, for MuJoCo's ray casting."""

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, ids: Indices, origin: Floats, axes: Floats) -> None:
        self.ids = ids
        self.origin, self.axes = origin, axes
        self.kind = model.geom_type[ids]
        self.position = (data.geom_xpos[ids] - origin) @ axes
        """The centre of each shape (n, 3) [m] in the camera's frame."""
        self.rotation = axes.T @ data.geom_xmat[ids].reshape(-1, 3, 3)
        """From the frame of each shape to the camera's (n, 3, 3)."""
        self.columns = np.ascontiguousarray(self.rotation.transpose(2, 1, 0).reshape(9, -1))
        """The axes of each shape (9, n): its x axis in the camera's frame, then y and z."""
        size = model.geom_size[ids]
        sphere = self.kind == mujoco.mjtGeom.mjGEOM_SPHERE
        size[sphere] = size[sphere, :1]
        self.size = size.astype(np.float32)
        self._half = model.geom_aabb[ids, 3:].copy()
        plane = self.kind == mujoco.mjtGeom.mjGEOM_PLANE
        self._half[plane] = size[plane] * (1.0, 1.0, 0.0)
        self._middle = np.einsum("nij,nj->ni", self.rotation, model.geom_aabb[ids, :3] * ~plane[:, None])
        self._middle += self.position
        self._radius = np.linalg.norm(self._half, axis=1)
        self.inverse = np.ascontiguousarray(self.rotation.swapaxes(1, 2), dtype=np.float32)
        self.traced = ~np.isin(self.kind, tuple(INTERVALS))
        """True for meshes and heightmaps."""

    @contextmanager
    def only(self, model: mujoco.MjModel, shapes: Indices) -> Iterator[None]:
        """Hide all but some shapes from MuJoCo's ray casting."""
        groups = model.geom_group.copy()
        model.geom_group[groups == VISUAL_GROUP] = SITE_GROUP
        model.geom_group[self.ids[shapes]] = VISUAL_GROUP
        try:
            yield
        finally:
            model.geom_group[:] = groups

    def met_by(self, bundles: Bundles, of: Indices, groups: Bundles | None = None) -> tuple[Indices, Indices]:
        """Return the pairs of bundles and shapes that may meet, sorted by bundle; `of` are the shapes to look at.

        No pair is missing; some do not meet. `groups` are bundles round each GROUP of `bundles`, looked at first.
        """
        coarse = bundles if groups is None else groups
        if not len(of) or not len(bundles.start):
            return np.zeros(0, np.intp), np.zeros(0, np.intp)
        step = max(1, _MOST_TESTED // len(of))
        near = [self._near(coarse, first, step, of) for first in range(0, len(coarse.start), step)]
        bundle, shape = (np.concatenate(each) for each in zip(*near, strict=True))
        if groups is not None:
            met = self._boxes_met(groups, bundle, shape)
            bundle, shape = bundle[met], shape[met]
            bundle = (bundle[:, None] * GROUP + np.arange(GROUP)).ravel()
            shape = np.repeat(shape, GROUP)
            exists = bundle < len(bundles.start)
            bundle, shape = bundle[exists], shape[exists]
        met = self._boxes_met(bundles, bundle, shape)
        bundle, shape = bundle[met], shape[met]
        if groups is not None:
            order = np.argsort(bundle, kind="stable")
            bundle, shape = bundle[order], shape[order]
        return bundle, shape

    def _near(self, bundles: Bundles, first: int, count: int, of: Indices) -> tuple[Indices, Indices]:
        """Return which of some bundles may meet the spheres round which shapes."""
        start, way, radius, spread, reach = (each[first : first + count] for each in bundles)
        middle, around = self._middle[of], self._radius[of]
        along = -np.einsum("ti,ti->t", start, way)[:, None] + _products(way, middle)
        square = np.einsum("ti,ti->t", start, start)[:, None] - 2.0 * _products(start, middle)
        square += np.einsum("gi,gi->g", middle, middle)
        square -= along * along
        limit = np.multiply.outer(np.sqrt(1.0 + spread * spread), around) + radius[:, None]
        met = limit + along >= 0.0
        limit += spread[:, None] * along
        met &= (limit > 0.0) & (square <= limit * limit + 1e-9)
        met &= along <= reach[:, None] + around + radius[:, None]
        bundle, which = np.nonzero(met)
        return bundle + first, of[which]

    def _boxes_met(self, bundles: Bundles, bundle: Indices, shape: Indices) -> NDArray[np.bool_]:
        """Tell which pairs of a bundle and the bounding box of a shape may meet."""
        column = self.columns[:, shape]
        start, way = bundles.start.T[:, bundle], bundles.way.T[:, bundle]
        radius, reach = bundles.radius[bundle], bundles.reach[bundle]
        between = start - self._middle.T[:, shape]
        farthest = np.sqrt(between[0] ** 2 + between[1] ** 2 + between[2] ** 2) + self._radius[shape]
        wide = radius + bundles.spread[bundle] * np.minimum(reach, farthest) + 1e-6
        enters, leaves = np.full(len(shape), -np.inf), np.full(len(shape), np.inf)
        for axis in range(3):
            x, y, z = column[3 * axis : 3 * axis + 3]
            toward = x * way[0] + y * way[1] + z * way[2]
            toward[np.abs(toward) < 1e-12] = 1e-12
            centre = -(x * between[0] + y * between[1] + z * between[2]) / toward
            width = (self._half[shape, axis] + wide) / np.abs(toward)
            np.maximum(enters, centre - width, out=enters)
            np.minimum(leaves, centre + width, out=leaves)
        met: NDArray[np.bool_] = (enters <= leaves) & (leaves >= -wide) & (enters <= reach + wide)
        return met


def _products(rows: Floats, columns: Floats) -> Floats:
    """Return the scalar products of each of (t, 3) with each of (g, 3), in this thread alone."""
    outer = np.multiply.outer
    return outer(rows[:, 0], columns[:, 0]) + outer(rows[:, 1], columns[:, 1]) + outer(rows[:, 2], columns[:, 2])
