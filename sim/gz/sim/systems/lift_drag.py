"""LiftDrag: lift and drag of a wing, a fin or a rotor blade, which is one link.

The velocity of the centre of pressure `<cp>` [m, in the link] through the air, without its part along the span, meets
the surface at the angle of attack alpha = a0 + its angle to `<forward>`. With the pressure q = air_density v^2 / 2
the lift is (cla alpha) q area, the drag |cda alpha| q area, both less by the square of the cosine of the sweep;
beyond `<alpha_stall>` the slopes are cla_stall and cda_stall. A `<control_joint_name>` adds control_joint_rad_to_cl
times its angle to the coefficient of lift. Below 0.01 m/s there is no force. The air moves with the wind of the
world. As in Gazebo the moment (cma) has no effect.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/lift_drag/LiftDrag.cc
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from gz_course.sim.gz.sim.physics.joint_axis import find_axes
from gz_course.sim.gz.sim.physics.pushes import cross, push, refresh_velocities, velocity
from gz_course.sim.gz.sim.plugins.model_scope import ModelScope
from gz_course.sim.gz.sim.plugins.system import System, UpdateInfo, system
from gz_course.sim.gz.sim.pose import Vector, rotate
from gz_course.sim.gz.sim.sdf.description import Model, Plugin
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.systems.beyond_the_course.wind_effects import wind_of

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess

SLOWEST = 0.01
"""Speed [m/s] through the air up to which there is no force."""
_QUARTER = math.pi / 2.0


@system("LiftDrag", "gz-sim-lift-drag-system")
class LiftDrag(System):
    """The aerodynamic force on one link. Parameters and defaults are Gazebo's."""

    pushes = True
    parameters = frozenset(
        (
            *("link_name", "control_joint_name", "control_joint_rad_to_cl", "cla", "cda", "cma", "alpha_stall"),
            *("cla_stall", "cda_stall", "cma_stall", "air_density", "radial_symmetry", "area", "a0", "cp", "forward"),
            "upward",
        )
    )

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        element = plugin.element
        self.world = world
        self.scope = ModelScope(world, model, plugin, self.name)
        self._link = self.scope.named_link(element)
        self._joint = next(iter(self.scope.find_joints(element, "control_joint_name")), None)
        if element.find("control_joint_name") is not None and self._joint is None:
            self._link = None  # As in Gazebo there is no force at all.
        numbers = {tag: element.number(tag, default) for tag, default in _DEFAULTS.items()}
        self._slope, self._drag_slope = numbers["cla"], numbers["cda"]
        self._stall, self._a0 = numbers["alpha_stall"], numbers["a0"]
        self._stalled_slope, self._stalled_drag_slope = numbers["cla_stall"], numbers["cda_stall"]
        self._half_density = numbers["air_density"] / 2.0 * numbers["area"]
        self._per_radian = numbers["control_joint_rad_to_cl"]
        self._radial = element.flag("radial_symmetry", False)
        self._cp = np.array(element.vector("cp", (0.0, 0.0, 0.0)))
        self._forward, self._upward = _unit(element, "forward", (1.0, 0.0, 0.0)), _unit(element, "upward", (0, 0, 1.0))
        if not all(map(math.isfinite, (*numbers.values(), *self._cp))):
            raise element.error("the parameters of LiftDrag must be finite")

    def bind(self) -> None:
        self._body = self.scope.body(self._link.name) if self._link is not None else -1
        joint = f"{self.scope.model.name}::{self._joint.name}" if self._joint is not None else ""
        self._wind = wind_of(self.world)
        self._axis = next(iter(find_axes(self.world.model, joint)), None) if joint else None

    def pre_update(self, info: UpdateInfo) -> None:
        if self._body <= 0:
            return
        data, body = self.world.data, self._body
        refresh_velocities(self.world)
        linear, angular = velocity(self.world, body)
        turn = data.xquat[body]
        lever = rotate(turn, self._cp)
        flow = linear + cross(angular, lever) - self._wind
        control = self._per_radian * self._axis.read_position(data) if self._axis is not None else 0.0
        force = self.force(flow, rotate(turn, self._forward), rotate(turn, self._upward), control)
        push(data, body, force, data.xpos[body] + lever)

    def force(self, flow: Vector, forward: Vector, upward: Vector, control: float = 0.0) -> Vector:
        """Return the force [N] at the velocity `flow` [m/s] through the air; `control` adds to the coefficient of lift.

        All vectors have the same axes.
        """
        speed = float(np.linalg.norm(flow))
        if speed <= SLOWEST:
            return np.zeros(3)
        if self._radial:
            upward = _normal(cross(forward, cross(forward, flow / speed)))
        span = _normal(cross(forward, upward))
        sine = min(max(float(span @ flow) / speed, -1.0), 1.0)
        sweep = 1.0 - sine * sine
        in_plane = flow - float(flow @ span) * span
        drag_direction, lift_direction = -_normal(in_plane), _normal(cross(span, in_plane))
        angle = math.acos(min(max(float(lift_direction @ upward), -1.0), 1.0))
        alpha = self._a0 + (angle if float(lift_direction @ forward) >= 0.0 else -angle)
        while abs(alpha) > _QUARTER:
            alpha -= math.copysign(math.pi, alpha)
        pressure = self._half_density * float(in_plane @ in_plane)
        lift = _coefficient(alpha, self._stall, self._slope, self._stalled_slope) * sweep
        if abs(alpha) > self._stall:
            lift = max(0.0, lift) if alpha > 0.0 else min(0.0, lift)
        drag = abs(_coefficient(alpha, self._stall, self._drag_slope, self._stalled_drag_slope) * sweep)
        return pressure * ((lift + control) * lift_direction + drag * drag_direction)


_DEFAULTS = {
    "cla": 1.0,
    "cda": 0.01,
    "alpha_stall": _QUARTER,
    "cla_stall": 0.0,
    "cda_stall": 1.0,
    "air_density": 1.2041,
    "area": 1.0,
    "a0": 0.0,
    "control_joint_rad_to_cl": 4.0,
}


def _coefficient(alpha: float, stall: float, slope: float, stalled_slope: float) -> float:
    """Return a coefficient that grows with `slope` up to the stall, then with `stalled_slope`."""
    if abs(alpha) <= stall:
        return slope * alpha
    edge = math.copysign(stall, alpha)
    return slope * edge + stalled_slope * (alpha - edge)


def _normal(vector: Vector) -> Vector:
    length = float(np.linalg.norm(vector))
    return vector / length if length > 0.0 else vector


def _unit(element: Element, tag: str, default: tuple[float, float, float]) -> Vector:
    vector = np.array(element.vector(tag, default))
    if not (np.isfinite(vector).all() and vector.any()):
        raise element.error(f"LiftDrag's <{tag}> must be a direction, got '{element.text_of(tag)}'")
    return _normal(vector)
