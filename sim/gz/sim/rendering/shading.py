"""Shades what a camera sees: ambient light, Lambert's cosine law and highlights for every light, shadows and sky.

It needs neither GPU nor OpenGL and gives the same bytes on every run. A surface shows its `rgba`, brightened by
emission and, where light is reflected into the camera, by its specular colour; a ray without a hit shows the background
of the scene, or a sky if `<scene>` has one.

Source: Lambert's cosine law, https://en.wikipedia.org/wiki/Lambert%27s_cosine_law
Source: Blinn's highlights, https://en.wikipedia.org/wiki/Blinn%E2%80%93Phong_reflection_model
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.physics.builder import VISUAL_GROUP
from gz_course.sim.gz.sim.physics.geoms import looks_of
from gz_course.sim.gz.sim.physics.materials import HORIZON, ZENITH
from gz_course.sim.gz.sim.rendering.facing import Seen
from gz_course.sim.gz.sim.rendering.geom_parts import geom_parts
from gz_course.sim.gz.sim.rendering.lamps import Lamp
from gz_course.sim.gz.sim.rendering.shadows import shade
from gz_course.sim.gz.sim.rendering.texturing import Textures
from gz_course.sim.gz.sim.rendering.tile_caster import View, in_blocks
from gz_course.sim.gz.sim.sdf.description import Light, Visual
from gz_course.sim.gz.sim.sdf.textures import Pixels

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess

Colours = NDArray[np.float32]

_SHININESS = 32.0
"""The exponent of highlights on materials that state none."""


class Shader:
    """Computes colours from the lights and surfaces of one world."""

    def __init__(self, world: WorldAccess) -> None:
        self._world = world
        self._background = np.array(world.description.background, dtype=np.float32)
        self._ambient = np.array(world.description.ambient, dtype=np.float32)
        self._sky = world.description.element.find("scene/sky") is not None

    def bind(self) -> None:
        """Read the colours of all geoms from MuJoCo's model, which was just built."""
        model = self._world.model
        self._colour = model.geom_rgba[:, :3].astype(np.float32)
        self._emission = np.zeros((model.ngeom, 3), dtype=np.float32)
        self._specular = np.zeros((model.ngeom, 3), dtype=np.float32)
        self._shininess = np.full(model.ngeom, _SHININESS, dtype=np.float32)
        self._casts = np.ones(model.ngeom, dtype=np.bool_)
        images: dict[int, Pixels] = {}
        for geom, _, _, part, number in geom_parts(self._world, VISUAL_GROUP):
            if isinstance(part, Visual):
                texture = looks_of(part)[number].texture
                if texture is not None:
                    images[geom] = texture
            self._casts[geom] = part.element.flag("cast_shadows", True)
            for tag, table in (("emissive", self._emission), ("specular", self._specular)):
                stated = part.element.find(f"material/{tag}")
                if stated is not None and len(stated.text.split()) in (3, 4):
                    table[geom] = np.clip(stated.floats(len(stated.text.split()))[:3], 0.0, 1.0)
            exponent = part.element.number("material/shininess", 0.0)
            if 0.0 < exponent < math.inf:
                self._shininess[geom] = exponent
        self._textures = Textures(model, images)
        self._described = self._lights()

    def _lights(self) -> dict[str, Light]:
        """Return the lights of the description by their names in MuJoCo's model."""
        world = self._world.description
        found = {light.name: light for light in world.lights}
        for model in world.models:
            for link in model.links:
                found |= {f"{model.name}::{link.name}::{light.name}": light for light in link.lights}
        return found

    def colours(self, view: View) -> Colours:
        """Return the colours (3, n), values 0..1, of the pixels, row-major."""
        lamps = self._lamps(view)
        shape = view.code.shape
        casters = np.flatnonzero(self._casts[view.surfaces.ids])
        facing = [_casters(lamp, view, casters) for lamp in lamps]
        tables = self._tables(view)
        result = np.empty((3, *shape), np.float32)

        def work(block: slice) -> None:
            seen = Seen(view, block)
            strengths = []
            for lamp, casting in zip(lamps, facing, strict=True):
                way = lamp.toward(seen.points)
                strength = seen.lambert(way[0])
                lamp.fade(*way, strength)
                if lamp.casts:
                    shade(lamp, view, block, casting, self._world, seen.points, way, strength)
                strengths.append(strength)
            self._mix(view, seen, tables, list(zip(lamps, strengths, strict=True)), result[:, block])

        in_blocks(view.tiles.count, work)
        return np.stack([view.tiles.joined(channel) for channel in result])

    def _tables(self, view: View) -> tuple[Colours, Colours, Colours]:
        """Return colour, emission and specular colour (3, shapes + 1) of all shapes; the last is for no shape."""
        tables = (self._colour, self._emission, self._specular)
        colour, emission, specular = (np.pad(each[view.surfaces.ids].T, ((0, 0), (0, 1))) for each in tables)
        return colour, emission, specular

    def _mix(
        self, view: View, seen: Seen, tables: tuple[Colours, Colours, Colours], lights: list[tuple[Lamp, Colours]],
        result: Colours,
    ) -> None:  # fmt: skip
        """Write the colours (3, tiles, pixels) of some tiles."""
        colour, emission, specular = tables
        shape = seen.code >> 3
        light, known = np.zeros(0, np.float32), None
        for channel in range(3):
            parts = [float(self._ambient[channel]), *(float(lamp.diffuse[channel]) for lamp, _ in lights)]
            if parts != known:  # white light is the same in all channels
                known, light = parts, np.full(shape.shape, self._ambient[channel], np.float32)
                for lamp, strength in lights:
                    light += strength * lamp.diffuse[channel]
            np.multiply(light, colour[channel][shape], out=result[channel])
        self._textures.colour(view, seen, result)
        for channel in range(3):
            if emission[channel].any():
                result[channel] += emission[channel][shape]
        if specular.any() and lights:
            self._add_highlights(view, seen, specular, lights, result)
        np.minimum(result, np.float32(1.0), out=result)
        missed = seen.code < 0
        if not self._sky:
            for channel in range(3):
                np.copyto(result[channel], self._background[channel], where=missed)
        elif missed.any():
            result[:, missed] = self.background(view.surfaces.axes.astype(np.float32) @ seen.rays[:, missed])

    def _add_highlights(
        self, view: View, seen: Seen, specular: Colours, lights: list[tuple[Lamp, Colours]], result: Colours
    ) -> None:
        shiny: NDArray[np.bool_] = np.any(specular, axis=0)
        places = np.nonzero(shiny[seen.code >> 3])
        at: Any = (slice(None), *places)
        shape = seen.code[places] >> 3
        exponent = self._shininess[view.surfaces.ids[shape]]
        there, facing, rays = seen.points[at], seen.normal[at], seen.rays[at]
        for lamp, strength in lights:
            half = lamp.toward(there[:, None])[0].reshape(3, -1) - rays
            half /= np.sqrt(np.einsum("ij,ij->j", half, half))
            cosine = np.maximum(np.einsum("ij,ij->j", half, facing), np.float32(0.0))
            gleam = cosine**exponent * (strength[places] > 0.0)
            result[at] += gleam * specular[:, shape] * lamp.specular[:, None]

    def background(self, rays: Colours) -> Colours:
        """Return the background colours (3, n) of rays (3, n) in the world: one colour, or a sky from pale at the
        horizon to blue above.
        """
        if not self._sky:
            return np.repeat(self._background[:, None], rays.shape[1], axis=1)
        height = np.sqrt(np.clip(rays[2], 0.0, 1.0))
        low, high = np.array(HORIZON), np.array(ZENITH)
        return (low[:, None] + height * (high - low)[:, None]).astype(np.float32)

    def _lamps(self, view: View) -> list[Lamp]:
        """Return the lights that are on, in the camera's frame."""
        model, data, surfaces = self._world.model, self._world.data, view.surfaces
        mujoco.mj_camlight(model, data)
        lamps = []
        for number in np.flatnonzero(model.light_active).tolist():
            kind = int(model.light_type[number])
            directional = kind == mujoco.mjtLightType.mjLIGHT_DIRECTIONAL
            described = self._described.get(model.light(number).name)
            cone = None
            if kind == mujoco.mjtLightType.mjLIGHT_SPOT:
                outer = math.radians(float(model.light_cutoff[number]))
                inner = min(outer, described.inner_angle / 2.0 if described is not None else outer)
                cone = math.cos(inner), math.cos(outer), described.falloff if described is not None else 1.0
            constant, linear, quadratic = model.light_attenuation[number].tolist()
            lamp = Lamp(
                None if directional else (data.light_xpos[number] - surfaces.origin) @ surfaces.axes,
                data.light_xdir[number] @ surfaces.axes,
                model.light_diffuse[number].astype(np.float32),
                model.light_specular[number].astype(np.float32),
                (constant, linear, quadratic),
                float(model.light_range[number]),
                cone,
                bool(model.light_castshadow[number]),
            )
            lamps.append(lamp)
        return lamps


def _casters(lamp: Lamp, view: View, casters: NDArray[np.intp]) -> NDArray[np.intp]:
    """Leave out planes that face the lamp: they shadow only what is below them."""
    surfaces = view.surfaces
    up = surfaces.rotation[casters][:, :, 2]
    if lamp.position is None:
        faces = up @ lamp.direction <= 0.0
    else:
        faces = np.einsum("ni,ni->n", lamp.position - surfaces.position[casters], up) >= 0.0
    kept: NDArray[np.intp] = casters[~(faces & (surfaces.kind[casters] == mujoco.mjtGeom.mjGEOM_PLANE))]
    return kept
