"""WindEffects: the wind of a world, and its force on the links for which `<enable_wind>` is set.

The wind follows `<linear_velocity>` of the world's `<wind>`, and what arrives as `gz.msgs.Wind` on `/world/W/wind`,
with low passes (`<time_for_rise>`) of its horizontal magnitude, its direction and its vertical part; a sine and noise
are added to magnitude and direction. The force on a link is mass * `<force_approximation_scaling_factor>` * (wind -
its velocity), at its centre of mass. The factor is a number, or k (px(x) + qy(y) + rz(z)) of cubic polynomials
(coefficients from the third power down), stated for the whole world or for regions (`<when xgt="0" zle="10">`). The
service `/world/W/wind_info` returns the last command.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/wind_effects/WindEffects.cc
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from gz_course.sim.gz.sim.physics.builder import scoped
from gz_course.sim.gz.sim.physics.pushes import push, refresh_velocities, velocity
from gz_course.sim.gz.sim.plugins.noise import Noise
from gz_course.sim.gz.sim.plugins.system import System, UpdateInfo, system
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.sim.pose import Vector
from gz_course.sim.gz.sim.sdf.description import Link, Model, Plugin
from gz_course.sim.gz.sim.sdf.element import Element

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node


@dataclass(frozen=True)
class _Factor:
    """The factor of the force within one region; `bounds` are axis (0, 1, 2), name of the comparison and limit [m]."""

    k: float
    polynomials: tuple[tuple[float, ...], ...]
    bounds: tuple[tuple[int, str, float], ...]

    def holds(self, place: Vector) -> bool:
        compare = {"gt": np.greater, "ge": np.greater_equal, "lt": np.less, "le": np.less_equal}
        return all(compare[name](place[axis], limit) for axis, name, limit in self.bounds)

    def at(self, place: Vector) -> float:
        if not self.polynomials:
            return self.k
        pairs = zip(self.polynomials, place.tolist(), strict=True)
        return self.k * sum(float(np.polyval(each, x)) for each, x in pairs)


@system("WindEffects", "gz-sim-wind-effects-system")
class WindEffects(System):
    """The system of the whole world. Parameters and defaults are Gazebo's."""

    parameters = frozenset(("horizontal", "vertical", "force_approximation_scaling_factor"))
    once = True
    pushes = True

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        element = plugin.element
        if model is not None:
            raise element.error("WindEffects belongs directly in the <world>, not inside a <model>")
        self.world = world
        magnitude, direction = element.find("horizontal/magnitude"), element.find("horizontal/direction")
        vertical = element.find("vertical")
        self._rises = [_positive(each, "time_for_rise") for each in (magnitude, direction, vertical)]
        self._magnitude_sine = _number(magnitude, "sin/amplitude_percent", 0.0), _positive(magnitude, "sin/period")
        self._direction_sine = _number(direction, "sin/amplitude", 0.0), _positive(direction, "sin/period")
        noises = (each.find("noise") if each is not None else None for each in (magnitude, direction, vertical))
        self._noises = [Noise.from_sdf(each) for each in noises]
        factor = element.find("force_approximation_scaling_factor")
        regions = list(factor.all("when")) if factor is not None else []
        self._factors = [_factor(each) for each in regions] or [_factor(factor)]
        self.velocity: Vector = np.zeros(3)
        """The present wind [m/s], always the same array."""
        self.topic = valid_topic(f"/world/{world.name}/wind")
        self.start()

    def bind(self) -> None:
        """Find the links that the wind moves, each with its body and its mass [kg]."""
        self._links = [
            (int(self.world.model.body(scoped(model, link.name)).id), link.inertial.mass)
            for model in self.world.description.models
            for link in model.links
            if not (model.static or link.static) and _is_blown(model, link)
        ]

    def start(self) -> None:
        self._seed = np.array(self.world.description.wind)
        self.velocity[:] = self._seed
        self.enabled = True
        self._magnitude = self._vertical = 0.0
        self._direction: float | None = None
        self._random = np.random.Generator(np.random.Philox(key=self.world.seed))
        self._biases = [noise.draw_bias(self._random) for noise in self._noises]

    def connect(self, node: Node) -> None:
        from gz_course.sim.gz.msgs.empty_pb2 import Empty
        from gz_course.sim.gz.msgs.wind_pb2 import Wind

        node.subscribe(Wind, self.topic, self._on_wind)

        def serve(_: Any) -> Wind:
            info = Wind(enable_wind=self.enabled)
            info.linear_velocity.x, info.linear_velocity.y, info.linear_velocity.z = self._seed.tolist()
            return info

        node.advertise_service(f"{self.topic}_info", Empty, Wind, serve)

    def _on_wind(self, message: Any) -> None:
        wind = message.linear_velocity
        if not all(map(math.isfinite, (wind.x, wind.y, wind.z))):
            self.world.drop_command(self.topic, f"linear_velocity=({wind.x}, {wind.y}, {wind.z})")
            return
        self._seed, self.enabled = np.array((wind.x, wind.y, wind.z)), message.enable_wind

    def pre_update(self, info: UpdateInfo) -> None:
        if not self.enabled:
            return
        self._blow(info.sim_time_ns * 1e-9, info.dt)
        if not self._links:
            return
        refresh_velocities(self.world)
        for body, mass in self._links:
            place = self.world.data.xpos[body]
            factor = next((each.at(place) for each in self._factors if each.holds(place)), 0.0)
            moved, _ = velocity(self.world, body)
            push(self.world.data, body, mass * factor * (self.velocity - moved), self.world.data.xipos[body])

    def _blow(self, now: float, dt: float) -> None:
        """Advance the wind by a step of `dt` [s] that ends at `now` [s]."""
        x, y, z = self._seed.tolist()
        by_magnitude, by_direction, by_vertical = (dt / rise for rise in self._rises)
        self._magnitude += by_magnitude * (math.hypot(x, y) - self._magnitude)
        self._vertical += by_vertical * (z - self._vertical)
        wanted = math.degrees(math.atan2(y, x))
        before = wanted if self._direction is None else self._direction
        self._direction = before + by_direction * (wanted - before)
        share, period = self._magnitude_sine
        magnitude = self._magnitude * (1.0 + share * math.sin(2.0 * math.pi * now / period))
        swing, period = self._direction_sine
        direction = self._direction + swing * math.sin(2.0 * math.pi * now / period)
        values = [
            value if noise.silent else noise.apply(np.array((value,)), bias, self._random).item()
            for value, noise, bias in zip(
                (magnitude, direction, self._vertical), self._noises, self._biases, strict=True
            )
        ]
        angle = math.radians(values[1])
        self.velocity[:] = values[0] * math.cos(angle), values[0] * math.sin(angle), values[2]


def wind_of(world: WorldAccess) -> Vector:
    """Return the wind [m/s] of a world, as an array that WindEffects keeps up to date."""
    running = next((each for each in world.systems if isinstance(each, WindEffects)), None)
    return running.velocity if running is not None else np.array(world.description.wind)


def _is_blown(model: Model, link: Link) -> bool:
    """Tell whether `<enable_wind>` is set for a link, by itself or else by the innermost model that states it."""
    parts = link.name.split("::")[:-1]
    inner = ["::".join(parts[: len(parts) - number]) for number in range(len(parts))]
    nested = [each for name in inner for each in model.nested if each.name == name]
    elements = [link.element, *(each.element for each in nested), model.element]
    stated = next((each for each in elements if each.find("enable_wind") is not None), None)
    return stated is not None and stated.flag("enable_wind", False)


def _factor(element: Element | None) -> _Factor:
    """Return the factor stated in an element; 1 everywhere without one."""
    if element is None:
        return _Factor(1.0, (), ())
    bounds = []
    for name, text in element.attributes.items():
        if name[:1] in ("x", "y", "z") and name[1:] in ("gt", "ge", "lt", "le"):
            try:
                bounds.append(("xyz".index(name[0]), name[1:], float(text)))
            except ValueError:
                raise element.error(f"{name} of <{element.tag}> must be a number, got '{text}'") from None
    if not any(element.find(tag) for tag in ("k", "px", "qy", "rz")):
        value = element.floats(1)[0]
        if not 0.0 <= value < math.inf:
            raise element.error(f"<force_approximation_scaling_factor> must not be negative, got {value:g}")
        return _Factor(value, (), tuple(bounds))
    polynomials = tuple(element.vector(tag, (0.0, 0.0, 0.0, 0.0)) for tag in ("px", "qy", "rz"))
    return _Factor(element.number("k", 1.0), polynomials, tuple(bounds))


def _number(element: Element | None, path: str, default: float) -> float:
    found = element.find(path) if element is not None else None
    return found.floats(1)[0] if found is not None else default


def _positive(element: Element | None, path: str) -> float:
    value = _number(element, path, 1.0)
    if not 1e-6 <= value < math.inf:
        assert element is not None
        raise element.error(f"WindEffects' <{path.rsplit('/', 1)[-1]}> must be greater than zero, got {value:g}")
    return value
