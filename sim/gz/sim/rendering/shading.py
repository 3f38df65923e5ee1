"""Shades the ray hits of cameras: ambient light, Lambert's cosine law for every light, shadows and sky.

It needs neither GPU nor OpenGL and gives the same bytes on every run. A surface shows its `rgba`, brightened by
emission; a ray without a hit shows the background of the scene, or a sky if `<scene>` has one. Attenuation is 1 /
(constant + linear d + quadratic d^2) at the distance d [m].

Source: Lambert's cosine law, https://en.wikipedia.org/wiki/Lambert%27s_cosine_law
Source: SDFormat, element `<light>` (attenuation), http://sdformat.org/spec?elem=light
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.physics.builder import SITE_GROUP, VISUAL_GROUP
from gz_course.sim.gz.sim.rendering.geom_parts import geom_parts
from gz_course.sim.gz.sim.rendering.ray_caster import Floats, Hits

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess

Colours = NDArray[np.float32]

_FAR_LIGHT = 1e4
"""Distance [m] of the point from which a directional light casts shadows: its rays are nearly parallel there, and
rounding errors are small.
"""
_SHADOW_GAP = 2e-3
"""Minimum distance [m] between a point and a surface that shadows it."""
_UNKNOWN = -1
_ZENITH = np.array((0.30, 0.52, 0.85))
_HORIZON = np.array((0.80, 0.88, 0.95))
_DIRECTIONAL = int(mujoco.mjtLightType.mjLIGHT_DIRECTIONAL)
_SPOT = int(mujoco.mjtLightType.mjLIGHT_SPOT)


class Shader:
    """Computes colours from the lights and surfaces of one world."""

    def __init__(self, world: WorldAccess) -> None:
        self._world = world
        self._background = np.array(world.description.background, dtype=np.float32)
        self._ambient = np.array(world.description.ambient, dtype=np.float32)
        self._sky = world.description.element.find("scene/sky") is not None
        self._groups = np.zeros(6, dtype=np.uint8)
        self._groups[VISUAL_GROUP] = 1

    def bind(self) -> None:
        """Read the colours of all geoms from MuJoCo's model, which was just built."""
        model = self._world.model
        # The additional last row is for rays without a hit (geom -1).
        self._colour = np.zeros((model.ngeom + 1, 3), dtype=np.float32)
        self._colour[:-1] = model.geom_rgba[:, :3]
        self._emission = np.zeros((model.ngeom + 1, 3), dtype=np.float32)
        self._shadowless: list[int] = []
        for geom, _, _, part in geom_parts(self._world, VISUAL_GROUP):
            if not part.element.flag("cast_shadows", True):
                self._shadowless.append(geom)
            emissive = part.element.find("material/emissive")
            if emissive is not None and len(emissive.text.split()) in (3, 4):
                self._emission[geom] = np.clip(emissive.floats(len(emissive.text.split()))[:3], 0.0, 1.0)
        self._emits = bool(self._emission.any())

    def colours(self, hits: Hits, width: int) -> Colours:
        """Return the colour (n, 3), values 0..1, of each ray.

        `hits` must have normals; its rays are in rows of `width`.
        """
        assert hits.normal is not None
        met = hits.geom >= 0
        points = hits.rays * hits.distance[:, None]
        points += hits.origin
        view = _View(met, points, hits.normal, hits.geom, width)
        model, data = self._world.model, self._world.data
        mujoco.mj_comPos(model, data)
        mujoco.mj_camlight(model, data)
        light: Colours | None = None
        for number in range(model.nlight):
            if model.light_active[number]:
                strength = self._from_light(number, view).astype(np.float32)
                more = np.multiply.outer(strength, model.light_diffuse[number])
                light = more if light is None else light + more
        result: Colours = self._colour[hits.geom]
        result *= self._ambient if light is None else np.add(light, self._ambient, out=light)
        if self._emits:
            result += self._emission[hits.geom]
        np.minimum(result, 1.0, out=result)
        missed = np.flatnonzero(~met)
        result[missed] = self.background(hits.rays[missed])
        return result

    def background(self, rays: Floats) -> Colours:
        """Return the background colours (n, 3) of rays (n, 3): one colour, or a sky from pale at the horizon to blue
        above.
        """
        if not self._sky:
            return np.tile(self._background, (len(rays), 1))
        height = np.sqrt(np.clip(rays[:, 2], 0.0, 1.0))[:, None]
        return (_HORIZON + height * (_ZENITH - _HORIZON)).astype(np.float32)

    def _from_light(self, number: int, view: _View) -> Floats:
        """Return the intensity of one light at each point (n,); 0 where nothing was hit."""
        model, data = self._world.model, self._world.data
        direction, kind = data.light_xdir[number], int(model.light_type[number])
        points, normals = view.points, view.normals
        strength: Floats
        if kind == _DIRECTIONAL:
            strength = -(normals @ direction)
            source = points[len(points) // 2] - direction * _FAR_LIGHT
        else:
            source = data.light_xpos[number].copy()
            way = points - source
            distance = np.maximum(np.linalg.norm(way, axis=1), 1e-6)
            way /= distance[:, None]
            strength = -np.einsum("ij,ij->i", normals, way)
            constant, linear, quadratic = model.light_attenuation[number]
            strength /= np.maximum(constant + distance * (linear + distance * quadratic), 1e-3)
            if kind == _SPOT:
                edge = np.cos(np.radians(min(float(model.light_cutoff[number]), 90.0)))
                strength *= np.clip((way @ direction - edge) / max(1.0 - edge, 1e-6) * 4.0, 0.0, 1.0)
        strength[~view.met] = 0.0
        np.maximum(strength, 0.0, out=strength)
        if model.light_castshadow[number]:
            strength[self._shadows(source, view, strength > 0.0)] = 0.0
        return strength

    def _shadows(self, source: Floats, view: _View, lit: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Tell for each `lit` point (n,) whether it is in the shadow of the light at `source`.

        Every second pixel of every second row is traced first. A pixel between them takes the result of those
        neighbours that lie on its own geom if they agree; the remaining ones are traced one by one.
        """
        width, height = view.width, len(view.geom) // view.width
        sparse = lit.reshape(height, width)[::2, ::2]
        points = view.points.reshape(height, width, 3)[::2, ::2]
        state = np.full(sparse.shape, _UNKNOWN, dtype=np.int8)
        state[sparse] = self._shadowed(source, points[sparse])
        verdicts = _spread(state, view.geom.reshape(height, width)).ravel()
        shadowed: NDArray[np.bool_] = verdicts == 1
        alone = lit & (verdicts == _UNKNOWN)
        shadowed[alone] = self._shadowed(source, view.points[alone])
        return shadowed

    def _shadowed(self, source: Floats, points: Floats) -> NDArray[np.bool_]:
        """Tell for each point (n, 3) whether a surface blocks the line to `source` (3,)."""
        count = len(points)
        if not count:
            return np.zeros(0, dtype=np.bool_)
        way = points - source
        distance = np.sqrt(np.einsum("ij,ij->i", way, way))
        way /= distance[:, None]
        model = self._world.model
        groups = model.geom_group[self._shadowless].copy()
        model.geom_group[self._shadowless] = SITE_GROUP
        met, geom = np.zeros(count), np.zeros(count, dtype=np.int32)
        try:
            mujoco.mj_multiRay(
                model, self._world.data, source, way.ravel(), self._groups, True, -1, geom, met, None, count, 1e10
            )
        finally:
            model.geom_group[self._shadowless] = groups
        shadowed: NDArray[np.bool_] = (met >= 0.0) & (met < distance - _SHADOW_GAP)
        return shadowed


class _View(NamedTuple):
    """The points to shade, in rows of `width`.

    `met` tells which rays hit a surface; `points`, `normals` and `geom` describe the surface there.
    """

    met: NDArray[np.bool_]
    points: Floats
    normals: Floats
    geom: NDArray[np.int32]
    width: int


def _spread(state: NDArray[np.int8], geom: NDArray[np.int32]) -> NDArray[np.int8]:
    """Return for each pixel of `geom` (h, w) the value of its neighbours in `state`, which holds every second pixel.

    Only neighbours on the same geom count; the value is _UNKNOWN if there are none or two disagree.
    """
    decided = np.full(geom.shape, _UNKNOWN, dtype=np.int8)
    for down, right in ((0, 0), (0, 1), (1, 0), (1, 1)):
        mine = geom[down::2, right::2]
        verdict = np.full(mine.shape, _UNKNOWN, dtype=np.int8)
        disagree = np.zeros(mine.shape, dtype=np.bool_)
        for row in range(down + 1):
            for column in range(right + 1):
                high, wide = min(len(mine), len(state) - row), min(mine.shape[1], state.shape[1] - column)
                if high <= 0 or wide <= 0:
                    continue
                around = state[row : row + high, column : column + wide]
                theirs = geom[2 * row :: 2, 2 * column :: 2][:high, :wide]
                here = verdict[:high, :wide]
                same = (theirs == mine[:high, :wide]) & (around != _UNKNOWN)
                disagree[:high, :wide] |= same & (here != _UNKNOWN) & (here != around)
                np.copyto(here, around, where=same)
        verdict[disagree] = _UNKNOWN
        decided[down::2, right::2] = verdict
    return decided
