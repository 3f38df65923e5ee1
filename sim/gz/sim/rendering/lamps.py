"""The lights of a world as a camera sees them: how strongly each lights a point, and what is in its shadow.

All coordinates are in the camera's frame. Attenuation is 1 / (constant + linear d + quadratic d^2) at the distance d
[m]; the light ends at its range. A spot light is full inside its inner angle, nothing outside its outer angle, and
follows the falloff between them.

Source: SDFormat, element `<light>` (attenuation, spot), http://sdformat.org/spec?elem=light
Source: https://github.com/OGRECave/ogre-next/blob/master/Docs/src/manual/lights.md (falloff of a spot light)
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import mujoco
import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.rendering.shapes import INTERVALS
from gz_course.sim.gz.sim.rendering.surfaces import GROUP, Bundles, Indices
from gz_course.sim.gz.sim.rendering.tile_caster import View, by_kind, layers, spread, turned
from gz_course.sim.gz.sim.rendering.viewpoint import Floats

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


@dataclass(eq=False)
class Lamp:
    """One light that is on: it shines from `position` [m], or from far away if that is None, along `direction`."""

    position: Floats | None
    direction: Floats
    diffuse: Values
    specular: Values
    attenuation: tuple[float, float, float]
    range: float
    cone: tuple[float, float, float] | None
    """The cosines of half the inner and half the outer angle of a spot light, and its falloff."""
    casts: bool

    def toward(self, points: Values) -> tuple[Values, Values | None]:
        """Return the directions (3, t, p) from points to the light, or (3, 1, 1), and the distances [m]."""
        if self.position is None:
            return -self.direction.astype(np.float32).reshape(3, 1, 1), None
        way = self.position.astype(np.float32).reshape(3, 1, 1) - points
        distance = np.sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2])
        np.maximum(distance, np.float32(1e-6), out=distance)
        way /= distance
        return way, distance

    def fade(self, toward: Values, distance: Values | None, strength: Values) -> None:
        """Weaken `strength` (t, p) by attenuation, range and cone."""
        if distance is not None:
            constant, linear, quadratic = (np.float32(value) for value in self.attenuation)
            strength /= np.maximum(constant + distance * (linear + distance * quadratic), np.float32(1e-3))
            strength[distance > self.range] = 0.0
        if self.cone is not None:
            inner, outer, falloff = self.cone
            x, y, z = self.direction.astype(np.float32)
            cosine = -(toward[0] * x + toward[1] * y + toward[2] * z)
            inside = np.clip((cosine - np.float32(outer)) / np.float32(max(inner - outer, 1e-6)), 0.0, 1.0)
            strength *= np.where(inside > 0.0, inside ** np.float32(falloff), np.float32(0.0))


def shade(
    lamp: Lamp, view: View, block: slice, casters: Indices, points: Values, way: tuple[Values, Values | None],
    strength: Values,
) -> None:  # fmt: skip
    """Set `strength` (t, p) to 0 at the points (3, t, p) of some tiles that a simple shape hides from the lamp."""
    lit = strength > 0.0
    tiles = np.flatnonzero(lit.any(axis=1))
    if not len(tiles):
        return
    surfaces, (toward, distance) = view.surfaces, way
    some, mask = points[:, tiles], lit[tiles]
    low = np.where(mask, some, np.float32(np.inf)).min(axis=2)
    high = np.where(mask, some, np.float32(-np.inf)).max(axis=2)
    begins = np.arange(0, len(tiles), GROUP)
    groups = _toward(lamp, np.minimum.reduceat(low, begins, axis=1), np.maximum.reduceat(high, begins, axis=1))
    which, caster = surfaces.met_by(_toward(lamp, low, high), casters, groups)
    # A convex shape does not shadow its own lit side.
    own = view.code[block][tiles] >> 3
    alone = np.where((own == own[:, :1]).all(axis=1), own[:, 0], -1)
    other = caster != alone[which]
    which, caster = which[other], caster[other]
    hidden = np.empty((len(which), lit.shape[1]), np.bool_)
    position = surfaces.position.astype(np.float32)
    for kind, rows in by_kind(surfaces.kind[caster], lit.shape[1]):
        each, where = caster[rows], tiles[which[rows]]
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
    shadow = np.zeros(lit.shape, np.bool_)
    for rows in layers(which):
        shadow[tiles[which[rows]]] |= hidden[rows]
    strength[shadow] = 0.0


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


def shade_by_meshes(
    lamp: Lamp, view: View, world: WorldAccess, casters: Indices, points: Values, strength: Values
) -> None:
    """Set `strength` (t, p) to 0 at the points (3, t, p) of some tiles that a mesh or heightmap hides from the lamp."""
    surfaces = view.surfaces
    lit = np.flatnonzero(strength > 0.0) if len(casters) else ()
    if not len(lit):
        return
    there = points.reshape(3, -1)[:, lit].T.astype(np.float64)
    source = lamp.position if lamp.position is not None else there[len(there) // 2] - lamp.direction * _FAR_LIGHT
    way = there - source
    distance = np.sqrt(np.einsum("ij,ij->i", way, way))
    way /= distance[:, None]
    none = np.zeros(len(way))
    near = np.unique(
        surfaces.met_by(Bundles(np.broadcast_to(source, way.shape), way, none, none, distance), casters)[0]
    )
    if not len(near):
        return
    count, rays = len(near), np.einsum("ij,nj->ni", surfaces.axes, way[near])
    met, geom = np.zeros(count), np.zeros(count, dtype=np.int32)
    start = surfaces.origin + surfaces.axes @ source
    with surfaces.only(world.model, casters):
        mujoco.mj_multiRay(
            world.model, world.data, start, rays.ravel(), surfaces.GROUPS, True, -1, geom, met, None, count, 1e10
        )
    hidden = (met >= 0.0) & (met < distance[near] - _GAP)
    strength.reshape(-1)[lit[near[hidden]]] = 0.0
