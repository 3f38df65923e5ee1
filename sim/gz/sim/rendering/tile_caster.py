"""Casts the rays of a camera: whole tiles against whole shapes, in NumPy; meshes and heightmaps with MuJoCo.

The rules are those of `ray_caster`: surfaces nearer than the near plane, hidden parts and the camera's own housing are
looked through. One thread does all, so that the same state gives the same pixels.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import mujoco
import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.physics.builder import VISUAL_GROUP
from gz_course.sim.gz.sim.rendering.shapes import INTERVALS, ROUND, Triple
from gz_course.sim.gz.sim.rendering.surfaces import GROUP, Bundles, Indices, Surfaces
from gz_course.sim.gz.sim.rendering.tiles import Tiles
from gz_course.sim.gz.sim.rendering.viewpoint import ALL_BITS, Floats, Viewpoint

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.sim.sdf.description import Sensor

NOTHING = -1
TRACED = 7
"""The face of what MuJoCo's ray casting has met."""
BLOCK = 1 << 15
"""Pixels times shapes that are intersected at once; their arrays fit the processor's cache."""
_TILES_AT_ONCE = 1280


_WIDEST = 1.4
"""The largest angle [rad] between the axis and the edge of a cone of rays."""


@dataclass(eq=False, slots=True)
class View:
    """What the rays of a camera hit; arrays are (tiles, pixels).

    `depth` is the distance along the ray [m], +inf for none. `code` is 8 times the index in `surfaces` plus the face,
    NOTHING for none. `normal` (tiles, pixels, 3) in the camera's frame is filled where the face is TRACED.
    """

    tiles: Tiles
    surfaces: Surfaces
    depth: NDArray[np.float32]
    code: NDArray[np.int32]
    normal: NDArray[np.float32] | None

    @property
    def distance(self) -> Floats:
        """The distance of each pixel (n,) [m], row-major; -1 for none."""
        return self.tiles.joined(np.where(self.code == NOTHING, -1.0, self.depth))

    @property
    def geom(self) -> NDArray[np.int32]:
        """The geom id of each pixel (n,), row-major; -1 for none."""
        known = np.append(self.surfaces.ids, -1).astype(np.int32)
        return self.tiles.joined(known[np.where(self.code == NOTHING, -1, self.code >> 3)])


class TileCaster(Viewpoint):
    """The rays of one camera, whose picture is cut into `tiles`."""

    def __init__(self, world: WorldAccess, sensor: Sensor, tiles: Tiles, mask: int = ALL_BITS) -> None:
        super().__init__(world, sensor, VISUAL_GROUP, mask)
        self._far = float(tiles.far.max())
        self.tiles = tiles
        every = np.zeros(tiles.count, np.intp)
        self._whole = _cones_round(tiles, every, self._far)
        self._groups = _cones_round(tiles, np.arange(tiles.count) // GROUP, self._far)
        self._cones = _cones_round(tiles, np.arange(tiles.count), self._far)

    def bind(self) -> None:
        super().bind()
        model = self._world.model
        self._ids = np.flatnonzero((model.geom_group == VISUAL_GROUP) & (model.geom_rgba[:, 3] > 0.0))
        self._seen = np.flatnonzero(~np.isin(self._ids, self._hidden))

    def look(self) -> View:
        """Cast all rays from the present pose of the camera."""
        world, tiles = self._world, self.tiles
        world.truth.refresh()
        origin = world.data.site_xpos[self._site].copy()
        axes = world.data.site_xmat[self._site].reshape(3, 3).copy()
        surfaces = Surfaces(world.model, world.data, self._ids, origin, axes)
        view = View(tiles, surfaces, tiles.far.copy(), np.full(tiles.far.shape, NOTHING, np.int32), None)
        seen = surfaces.met_by(self._whole, self._seen)[1]
        simple = seen[~surfaces.traced[seen]]
        in_blocks(tiles.count, lambda block: self._meet(view, block, simple))
        traced = seen[surfaces.traced[seen]]
        if len(traced):
            self._trace(view, traced)
        np.copyto(view.depth, np.float32(np.inf), where=view.code == NOTHING)
        return view

    def _meet(self, view: View, block: slice, shapes: Indices) -> None:
        """Find the nearest of `shapes` on each ray of some tiles."""
        tiles, surfaces = self.tiles, view.surfaces
        bundles = Bundles(*(each[block] for each in self._cones))
        groups = Bundles(*(each[block.start // GROUP : -(-block.stop // GROUP)] for each in self._groups))
        tile, shape = surfaces.met_by(bundles, shapes, groups)
        rays, near = tiles.rays[:, block], tiles.near[block]
        met = np.empty((len(tile), rays.shape[2]), np.float32)
        code = np.empty(met.shape, np.int32)
        origins = -np.einsum("nij,nj->ni", surfaces.inverse, surfaces.position).astype(np.float32)
        for kind, rows in by_kind(surfaces.kind[shape], rays.shape[2]):
            each, where = shape[rows], tile[rows]
            direction = turned(surfaces.inverse[each], rays[:, where])
            origin = spread(origins[each])
            first, last, face = INTERVALS[kind](origin, direction, spread(surfaces.size[each]))
            hit = first <= last
            begins = near[where]
            inside = first < begins
            inside &= hit
            if inside.any():
                first[inside] = np.where(last >= begins, last, np.inf)[inside]
                face = np.where(inside, np.int8(face if kind == mujoco.mjtGeom.mjGEOM_PLANE else ROUND), face)
            first[~hit] = np.inf
            met[rows] = first
            code[rows] = (each.astype(np.int32) << 3)[:, None] + face
        depth, codes = view.depth[block], view.code[block]
        for rows in layers(tile):
            where = tile[rows]
            before, now = depth[where], met[rows]
            nearer = now < before
            depth[where] = np.minimum(before, now)
            codes[where] = np.where(nearer, code[rows], codes[where])

    def _trace(self, view: View, traced: Indices) -> None:
        """Let MuJoCo cast the rays of the tiles in which a mesh or heightmap may be."""
        tiles, surfaces, model, data = self.tiles, view.surfaces, self._world.model, self._world.data
        where = np.unique(surfaces.met_by(self._cones, traced)[0])
        if not len(where):
            return
        rays = np.einsum("ij,jtp->tpi", surfaces.axes, tiles.rays[:, where], dtype=np.float64).reshape(-1, 3)
        count = len(rays)
        geom, met, normal = np.zeros(count, np.int32), np.zeros(count), np.zeros((count, 3))
        near = tiles.near[where].ravel()
        with surfaces.only(model, traced):
            mujoco.mj_multiRay(
                model, data, surfaces.origin, rays.ravel(), surfaces.GROUPS, True, -1, geom, met, normal.reshape(-1),
                count, self._far,
            )  # fmt: skip
            for ray in np.flatnonzero((met >= 0.0) & (met < near)).tolist():
                start = surfaces.origin + near[ray] * rays[ray]
                one = geom[ray : ray + 1], normal[ray]
                beyond = mujoco.mj_ray(model, data, start, rays[ray], surfaces.GROUPS, True, -1, *one)
                met[ray] = near[ray] + beyond if beyond >= 0.0 else -1.0
        met[geom < 0] = -1.0
        index = np.zeros(model.ngeom, np.int32)
        index[surfaces.ids] = np.arange(len(surfaces.ids))
        distance = met.reshape(len(where), -1).astype(np.float32)
        nearer = (distance >= 0.0) & (distance < view.depth[where])
        view.depth[where] = np.where(nearer, distance, view.depth[where])
        code = (index[geom].reshape(nearer.shape) << 3) + TRACED
        view.code[where] = np.where(nearer, code, view.code[where])
        view.normal = np.zeros((*view.code.shape, 3), np.float32)
        view.normal[where] = (normal @ surfaces.axes).reshape(*nearer.shape, 3)


def _cones_round(tiles: Tiles, group: Indices, reach: float) -> Bundles:
    """Return a cone round all tiles of each group, given by its number for each tile."""
    count = int(group[-1]) + 1
    axes: Floats = np.stack([np.bincount(group, tiles.axes[:, axis]) for axis in range(3)], axis=1).astype(np.float64)
    length = np.linalg.norm(axes, axis=1, keepdims=True)
    ahead = np.array((1.0, 0.0, 0.0))
    axes = np.where(length > 1e-6, axes / np.maximum(length, 1e-6), ahead).astype(np.float64)
    away = np.arccos(np.clip(np.einsum("ti,ti->t", axes[group], tiles.axes), -1.0, 1.0)) + tiles.angles
    angles = np.zeros(count)
    np.maximum.at(angles, group, away)
    wide = np.minimum(angles, _WIDEST)
    # A cone that is nearly a half space, or more, encloses everything that its tiles can reach.
    start, radius = np.zeros((count, 3)), np.where(angles > _WIDEST, reach, 0.0)
    return Bundles(start, axes, radius, np.tan(wide), np.full(count, reach))


def turned(inverse: NDArray[np.float32], vectors: NDArray[np.float32] | Triple) -> Triple:
    """Return vectors (3, k, p) in other frames, `inverse` (k, 3, 3)."""
    x, y, z = vectors
    row = inverse[..., None]
    return (
        row[:, 0, 0] * x + row[:, 0, 1] * y + row[:, 0, 2] * z,
        row[:, 1, 0] * x + row[:, 1, 1] * y + row[:, 1, 2] * z,
        row[:, 2, 0] * x + row[:, 2, 1] * y + row[:, 2, 2] * z,
    )


def spread(values: NDArray[np.float32]) -> Triple:
    """Return values (k, 3) as three columns (k, 1)."""
    return values[:, :1], values[:, 1:2], values[:, 2:]


def by_kind(kinds: NDArray[np.int32], pixels: int) -> Iterator[tuple[int, Indices]]:
    """Yield each kind of shape with the places of it, at most BLOCK pixels at once."""
    many = max(1, BLOCK // pixels)
    for kind in np.unique(kinds).tolist():
        places = np.flatnonzero(kinds == kind)
        for first in range(0, len(places), many):
            yield kind, places[first : first + many]


def layers(tile: Indices) -> Iterator[Indices]:
    """Yield places of sorted tile numbers, no tile twice at once."""
    if not len(tile):
        return
    place = np.arange(len(tile))
    begins = np.concatenate(([True], tile[1:] != tile[:-1]))
    rank = place - np.maximum.accumulate(np.where(begins, place, 0))
    order = np.argsort(rank, kind="stable")
    ends = np.cumsum(np.bincount(rank))
    first = 0
    for end in ends.tolist():
        yield order[first:end]
        first = end


def in_blocks(tiles: int, work: Callable[[slice], None]) -> None:
    """Call `work` for all tiles, some at a time."""
    with np.errstate(all="ignore"):
        for first in range(0, tiles, _TILES_AT_ONCE):
            work(slice(first, min(first + _TILES_AT_ONCE, tiles)))
