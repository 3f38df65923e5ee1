"""Colours for what camera rays met: ambient light, Lambert's law for every light of the world, shadows, sky.

Plain arithmetic on MuJoCo's ray hits, so that images need no GPU and no OpenGL and are the same bytes on every run.
A surface shows its `rgba`, brightened by emission; a ray that met nothing shows the scene's background, or a sky
when `<scene>` has one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import mujoco
import numpy as np
from numpy.typing import NDArray

from gz.sim.physics.builder import SITE_GROUP, VISUAL_GROUP
from gz.sim.sensors.geom_parts import geom_parts
from gz.sim.sensors.ray_caster import Floats, Hits

if TYPE_CHECKING:
    from gz.sim.world import World

_FAR_LIGHT = 1e4
"""Distance (m) at which a directional light is taken to stand when its shadows are cast: straight enough, and no
digits are lost.
"""
_SHADOW_GAP = 2e-3
"""A surface shadows a point only when it is at least this far (m) before it."""
_ZENITH = np.array((0.30, 0.52, 0.85))
_HORIZON = np.array((0.80, 0.88, 0.95))
_DIRECTIONAL = int(mujoco.mjtLightType.mjLIGHT_DIRECTIONAL)
_SPOT = int(mujoco.mjtLightType.mjLIGHT_SPOT)


class Shader:
    """Knows the lights and surfaces of one world."""

    def __init__(self, world: World) -> None:
        self._world = world
        self._background = np.array(world.description.background)
        self._ambient = np.array(world.description.ambient)
        self._sky = world.description.element.find("scene/sky") is not None
        self._groups = np.zeros(6, dtype=np.uint8)
        self._groups[VISUAL_GROUP] = 1

    def bind(self) -> None:
        """Take the colours of all geoms; MuJoCo's model was just built."""
        model = self._world.model
        self._colour = model.geom_rgba[:, :3].astype(np.float64)
        self._emission = np.zeros((model.ngeom, 3))
        self._shadowless: list[int] = []
        for geom, _, _, part in geom_parts(self._world, VISUAL_GROUP):
            if not part.element.flag("cast_shadows", True):
                self._shadowless.append(geom)
            emissive = part.element.find("material/emissive")
            if emissive is not None and len(emissive.text.split()) in (3, 4):
                self._emission[geom] = np.clip(emissive.floats(len(emissive.text.split()))[:3], 0.0, 1.0)

    def colours(self, hits: Hits) -> Floats:
        """Return the colour (n, 3), each 0..1, each ray sees. `hits` must hold normals."""
        assert hits.normal is not None
        seen = np.flatnonzero(hits.geom >= 0)
        result = self._sky_colours(hits.rays) if self._sky else np.tile(self._background, (len(hits.geom), 1))
        if not len(seen):
            return np.clip(result, 0.0, 1.0)
        geoms, normals = hits.geom[seen], hits.normal[seen]
        points = hits.origin + hits.rays[seen] * hits.distance[seen, None]
        light = np.tile(self._ambient, (len(seen), 1))
        model, data = self._world.model, self._world.data
        mujoco.mj_comPos(model, data)
        mujoco.mj_camlight(model, data)
        for number in range(model.nlight):
            if model.light_active[number]:
                light += self._from_light(number, points, normals)
        light *= self._colour[geoms]
        light += self._emission[geoms]
        result[seen] = light
        return np.clip(result, 0.0, 1.0)

    def _sky_colours(self, rays: Floats) -> Floats:
        """Return a sky (n, 3): pale at the horizon, blue above."""
        height = np.sqrt(np.clip(rays[:, 2], 0.0, 1.0))[:, None]
        return _HORIZON + height * (_ZENITH - _HORIZON)

    def _from_light(self, number: int, points: Floats, normals: Floats) -> Floats:
        """Return what one light adds at each point (n, 3)."""
        model, data = self._world.model, self._world.data
        direction, kind = data.light_xdir[number], int(model.light_type[number])
        if kind == _DIRECTIONAL:
            strength = -(normals @ direction)
            source = points.mean(axis=0) - direction * _FAR_LIGHT
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
        np.maximum(strength, 0.0, out=strength)
        if model.light_castshadow[number]:
            lit = np.flatnonzero(strength > 0.0)
            strength[lit[self._shadowed(source, points[lit])]] = 0.0
        return strength[:, None] * model.light_diffuse[number].astype(np.float64)

    def _shadowed(self, source: Floats, points: Floats) -> NDArray[np.bool_]:
        """Tell for each point (n, 3) whether something stands between it and `source` (3,)."""
        count = len(points)
        if not count:
            return np.zeros(0, dtype=np.bool_)
        way = points - source
        distance = np.linalg.norm(way, axis=1)
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
