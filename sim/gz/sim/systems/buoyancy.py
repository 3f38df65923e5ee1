"""Buoyancy: the links of a world float in a fluid, after Archimedes.

Every link that moves, or those of `<enable>` (`model` or `model::link`), is pushed against gravity with the weight of
the fluid that its collisions displace. The fluid has one density (`<uniform_fluid_density>`, 1000 kg/m^3 if nothing
is stated), or one for each layer (`<graded_buoyancy>`): `<default_density>` at the bottom, and above every
`<above_depth>` [m] the `<density>` of its `<density_change>`.

As in Gazebo the force of a uniform fluid acts at the mean of the places of the collisions, weighted with their volumes.
Unlike in Gazebo layers are cut level by boxes that lie aslant, and cylinders and meshes float between layers, too.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/buoyancy/Buoyancy.cc
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.physics.builder import scoped
from gz_course.sim.gz.sim.physics.displacement import Solid
from gz_course.sim.gz.sim.physics.pushes import push
from gz_course.sim.gz.sim.plugins.system import System, UpdateInfo, system
from gz_course.sim.gz.sim.pose import Vector, matrix, rotate
from gz_course.sim.gz.sim.sdf.description import Link, Model, Plugin
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.sdf.inertia import solid

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess

WATER = 1000.0
_FLAT = ("plane", "heightmap")


@dataclass(frozen=True, slots=True)
class _Floating:
    """A link in a uniform fluid: its body, `volume` [m^3], and the `centre` [m] of the volume in the link."""

    body: int
    volume: float
    centre: Vector


@dataclass(frozen=True, slots=True)
class _Layered:
    """A collision between layers: the body of its link, and its shape with its place in the link."""

    body: int
    shape: Solid
    position: Vector
    turn: Vector


@system("Buoyancy", "gz-sim-buoyancy-system")
class Buoyancy(System):
    """The system of the whole world."""

    parameters = frozenset(("uniform_fluid_density", "graded_buoyancy", "enable"))
    once = True
    pushes = True

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        element = plugin.element
        if model is not None:
            raise element.error("Buoyancy belongs directly in the <world>, not inside a <model>")
        self.world = world
        self.density = WATER
        self.layers: list[tuple[float, float]] = []
        """The lower boundary [m] and the density [kg/m^3] of each layer above the lowest, from below."""
        graded = element.find("graded_buoyancy")
        self._graded = graded is not None and element.find("uniform_fluid_density") is None
        if graded is not None and self._graded:
            self.density = _density(graded, "default_density")
            layers = {
                change.number("above_depth", 0.0): _density(change, "density", 0.0)
                for change in graded.all("density_change")
            }
            self.layers = sorted(layers.items())
        else:
            self.density = _density(element, "uniform_fluid_density")
        self._enabled = {child.text: child for child in element.all("enable")}

    def bind(self) -> None:
        """Find the links that float, and their volumes."""
        models = self.world.description.models
        self._floating: list[_Floating] = []
        self._layered: list[_Layered] = []
        for model in models:
            for link in model.links:
                if not (model.static or link.static) and self._is_enabled(scoped(model, link.name)):
                    self._add(model, link)
        names = {scoped(model, link.name) for model in models for link in model.links} | {each.name for each in models}
        names |= {scoped(model, nested.name) for model in models for nested in model.nested}
        for name in [name for name in self._enabled if name not in names]:
            text = f"Buoyancy's <enable> names '{name}', which does not exist{did_you_mean(name, names)}"
            self.world.diagnostics.warn(self._enabled[name].where, text)

    def _is_enabled(self, link: str) -> bool:
        return not self._enabled or any(link == name or link.startswith(f"{name}::") for name in self._enabled)

    def _add(self, model: Model, link: Link) -> None:
        body = int(self.world.model.body(scoped(model, link.name)).id)
        volume, moment = 0.0, np.zeros(3)
        for part in link.collisions:
            found = solid(part.geometry)
            if found is None or part.geometry.kind in _FLAT:
                continue
            volume += found[0]
            moment += found[0] * part.pose.position
            if self._graded:
                try:
                    shape = Solid(part.geometry)
                except ValueError:
                    text = f"collision '{part.name}' is a {part.geometry.kind}, which does not float between layers; "
                    self.world.diagnostics.warn(part.element.where, f"{text}use a box, sphere, cylinder or mesh")
                    continue
                self._layered.append(_Layered(body, shape, part.pose.position, matrix(part.pose.quaternion)))
        if volume > 0.0 and not self._graded:
            self._floating.append(_Floating(body, volume, moment / volume))

    def pre_update(self, info: UpdateInfo) -> None:
        data, up = self.world.data, -self.world.model.opt.gravity
        self.world.truth.refresh()
        for link in self._floating:
            place = data.xpos[link.body] + rotate(data.xquat[link.body], link.centre)
            push(data, link.body, self.density * link.volume * up, place)
        for part in self._layered:
            turn = data.xmat[part.body].reshape(3, 3)
            self._push_between(part, data.xpos[part.body] + turn @ part.position, turn @ part.turn, up)

    def _push_between(self, part: _Layered, position: Vector, turn: Vector, up: Vector) -> None:
        """Push one collision with the weight of what it displaces in each layer."""
        density, under, moment = self.density, 0.0, np.zeros(3)
        for level, next_density in (*self.layers, (math.inf, 0.0)):
            volume, centre = part.shape.below(level, position, turn)
            if volume - under > 1e-10:
                place = (volume * centre - moment) / (volume - under)
                push(self.world.data, part.body, density * (volume - under) * up, place)
                under, moment = volume, volume * centre
            density = next_density


def _density(element: Element, tag: str, default: float = WATER) -> float:
    value = element.number(tag, default)
    if not 0.0 <= value < math.inf:
        raise (element.find(tag) or element).error(f"Buoyancy's <{tag}> must be finite and not negative, got {value:g}")
    return value
