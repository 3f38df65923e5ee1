"""The shadows of a picture: which points does a surface hide from a lamp.

All coordinates are in the camera's frame. Whole tiles are compared with whole shapes first, as for the picture itself;
meshes and heightmaps are traced by MuJoCo.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import mujoco
import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.rendering.lamps import Lamp
from gz_course.sim.gz.sim.rendering.shapes import INTERVALS
from gz_course.sim.gz.sim.rendering.surfaces import GROUP, Bundles, Indices
from gz_course.sim.gz.sim.rendering.tile_caster import View, by_kind, layers, spread, turned

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess

Values = NDArray[np.float32]

_FAR_LIGHT = 1e4
"""Distance [m] of the point from which a directional light is traced: its rays are nearly parallel there, and rounding
errors are small.
"""
_GAP = np.float32(2e-3)
"""Minimum distance [m] between a point and a surface that shadows it."""
_ENDLESS = 1e6  # [m]


def shade(
    lamp: Lamp, view: View, block: slice, casters: Indices, world: WorldAccess, points: Values,
    way: tuple[Values, Values | None], strength: Values,
) -> None:  # fmt: skip
    """Set `strength` (t, p) to 0 at the points (3, t, p) of some tiles that a surface hides from the lamp."""
    lit = strength > 0.0
    tiles = np.flatnonzero(lit.any(axis=1))
    if not len(tiles) or not len(casters):
        return
    surfaces = view.surfaces
    some, mask = points[:, tiles], lit[tiles]
    low = np.where(mask, some, np.float32(np.inf)).min(axis=2)
    high = np.where(mask, some, np.float32(-np.inf)).max(axis=2)
    begins = np.arange(0, len(tiles), GROUP)
    groups = _toward(lamp, np.minimum.reduceat(low, begins, axis=1), np.maximum.reduceat(high, begins, axis=1))
    which, caster = surfaces.met_by(_toward(lamp, low, high), casters, groups)
    traced = surfaces.traced[caster]
    if traced.any():
        beside = np.zeros(lit.shape, np.bool_)
        beside[tiles[which[traced]]] = True
        _trace(lamp, view, world, casters[surfaces.traced[casters]], points, np.flatnonzero(lit & beside), strength)
    # A convex shape does not shadow its own lit side.
    own = view.code[block][tiles] >> 3
    alone = np.where((own == own[:, :1]).all(axis=1), own[:, 0], -1)
    other = (caster != alone[which]) & ~traced
    _hide(view, caster[other], tiles[which[other]], points, way, strength)


def _hide(
    view: View, caster: Indices, tile: Indices, points: Values, way: tuple[Values, Values | None], strength: Values
) -> None:
    """Intersect the pairs of a simple shape and a tile, sorted by tile."""
    surfaces, (toward, distance) = view.surfaces, way
    pixels = strength.shape[1]
    hidden = np.empty((len(tile), pixels), np.bool_)
    position = surfaces.position.astype(np.float32)
    for kind, rows in by_kind(surfaces.kind[caster], pixels):
        each, where = caster[rows], tile[rows]
        x, y, z = spread(position[each])
        there = points[:, where]
        inverse = surfaces.inverse[each]
        origin = turned(inverse, (there[0] - x, there[1] - y, there[2] - z))
        direction = turned(inverse, toward if toward.shape[1] == 1 else toward[:, where])
        first, last, _ = INTERVALS[kind](origin, direction, spread(surfaces.size[each]))
        blocked = first <= last
        blocked &= last > _GAP
        blocked &= first < (np.float32(_ENDLESS) if distance is None else distance[where])
        hidden[rows] = blocked
    shadow = np.zeros(strength.shape, np.bool_)
    for rows in layers(tile):
        shadow[tile[rows]] |= hidden[rows]
    strength[shadow] = 0.0


def _trace(
    lamp: Lamp, view: View, world: WorldAccess, casters: Indices, points: Values, places: Indices, strength: Values
) -> None:
    """Let MuJoCo cast rays from the lamp to the points at some places, counted in the order of the pixels."""
    surfaces = view.surfaces
    there = points.reshape(3, -1)[:, places].T.astype(np.float64)
    source = lamp.position if lamp.position is not None else there[len(there) // 2] - lamp.direction * _FAR_LIGHT
    way = there - source
    distance = np.sqrt(np.einsum("ij,ij->i", way, way))
    rays = np.einsum("ij,nj->ni", surfaces.axes, way / distance[:, None])
    met, geom = np.zeros(len(rays)), np.zeros(len(rays), dtype=np.int32)
    start = surfaces.origin + surfaces.axes @ source
    with surfaces.only(world.model, casters):
        mujoco.mj_multiRay(
            world.model, world.data, start, rays.ravel(), surfaces.GROUPS, True, -1, geom, met, None, len(rays), 1e10
        )
    strength.reshape(-1)[places[(met >= 0.0) & (met < distance - _GAP)]] = 0.0


def _toward(lamp: Lamp, low: Values, high: Values) -> Bundles:
    """Return the bundles of rays from what is between the corners `low` and `high` (3, n) to a lamp."""
    middle = ((low + high) / 2.0).T.astype(np.float64)
    radius = np.linalg.norm(high - low, axis=0) / 2.0 + 1e-4
    none = np.zeros(len(middle))
    if lamp.position is None:
        return Bundles(middle, np.broadcast_to(-lamp.direction, middle.shape), radius, none, none + _ENDLESS)
    ways = lamp.position - middle
    reach = np.maximum(np.linalg.norm(ways, axis=1), 1e-6)
    return Bundles(middle, ways / reach[:, None], radius, none, reach)
