"""Hydrodynamics: damping, added mass and current for one link of a boat or underwater vehicle, after Fossen.

With the velocity nu = (u, v, w, p, q, r) of the link in its own axes, linear parts relative to the current, the force
and torque are  tau = (D + Q |nu| + R nu) nu + M_a dnu/dt + C(M_a) nu.  Parameters are named as by SNAME: the row x,
y, z, k, m, n and the velocity U, V, W, P, Q, R, as in `<xU>` (D), `<xUabsU>` (Q), `<xUU>` (R) and `<xDotU>` (M_a).
What slows down and what adds mass is negative. `gz.msgs.Vector3d` [m/s] on `/ocean_current`, or
`/model/NAMESPACE/ocean_current` with `<namespace>`, sets the current.

Gazebo applies the added mass with the acceleration of the last step, which explodes for an added mass above that of
the link. Here it meets the acceleration that the other forces of the last step cause, so it is stable. C has Gazebo's
signs, which are not Fossen's.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/hydrodynamics/Hydrodynamics.cc; T. Fossen, Guidance
and Control of Ocean Vehicles, 1994, p. 37 and 43
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from gz_course.sim.gz.sim.physics.pushes import cross, push, refresh_velocities, velocity
from gz_course.sim.gz.sim.plugins.model_scope import ModelScope
from gz_course.sim.gz.sim.plugins.system import System, UpdateInfo, system
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.sim.pose import Vector, matrix
from gz_course.sim.gz.sim.sdf.description import Link, Model, Plugin
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.sdf.inertia import point_inertia, tensor

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node

_ROWS, _VELOCITIES = "xyzkmn", "UVWPQR"
_OTHERS = (
    "link_name",
    "namespace",
    "default_current",
    "water_density",
    "waterDensity",
    "disable_coriolis",
    "disable_added_mass",
)


def _names(middle: str, end: str = "") -> list[str]:
    return [f"{row}{middle}{column}{end}" for row in _ROWS for column in _VELOCITIES]


@system("Hydrodynamics", "gz-sim-hydrodynamics-system")
class Hydrodynamics(System):
    """The water around one link. Parameters and defaults are Gazebo's."""

    pushes = True
    parameters = frozenset(
        [*_OTHERS, *_names(""), *_names("Dot")]
        + [name for each in _VELOCITIES for name in (*_names("", each), *_names("", f"abs{each}"))]
    )

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        element = plugin.element
        self.world = world
        self.scope = ModelScope(world, model, plugin, self.name)
        self._link = self.scope.named_link(element)
        self._linear = _table(element, _names(""))
        self._quadratic = np.stack([_table(element, _names("", each)) for each in _VELOCITIES], axis=2)
        self._absolute = np.stack([_table(element, _names("", f"abs{each}")) for each in _VELOCITIES], axis=2)
        added = _table(element, _names("Dot"))
        self._coriolis = np.zeros(6) if element.flag("disable_coriolis", False) else np.diag(added).copy()
        self._added = np.zeros((6, 6)) if element.flag("disable_added_mass", False) else added
        self._current: Vector = np.array(element.vector("default_current", (0.0, 0.0, 0.0)))
        if not np.isfinite(self._current).all():
            raise element.error("Hydrodynamics' <default_current> must be finite")
        space = element.text_of("namespace")
        self.topic = valid_topic(f"/model/{space}/ocean_current" if space else "/ocean_current")
        self._answer = _answer(-self._added, self._link) if self._link is not None else None

    def bind(self) -> None:
        self._body = self.scope.body(self._link.name) if self._link is not None else -1

    def start(self) -> None:
        self.current = self._current
        """The velocity [m/s] of the water."""
        self._before: Vector | None = None
        self._forced = np.zeros(6)

    def connect(self, node: Node) -> None:
        from gz_course.sim.gz.msgs.vector3d_pb2 import Vector3d

        node.subscribe(Vector3d, self.topic, self._on_current)

    def _on_current(self, message: Any) -> None:
        if not all(map(math.isfinite, (message.x, message.y, message.z))):
            self.world.drop_command(self.topic, f"({message.x}, {message.y}, {message.z})")
            return
        self.current = np.array((message.x, message.y, message.z))

    def pre_update(self, info: UpdateInfo) -> None:
        if self._body <= 0:
            return
        data, body = self.world.data, self._body
        refresh_velocities(self.world)
        linear, angular = velocity(self.world, body)
        turn = data.xmat[body].reshape(3, 3)
        state = np.concatenate(((linear - self.current) @ turn, angular @ turn))
        before, self._before = state if self._before is None else self._before, state
        change = (state - before) / info.dt
        if self._answer is None:
            self._forced = self._added @ change
        else:
            inertia, response = self._answer
            self._forced = self._added @ (response @ (inertia @ change - self._forced))
        damping = self._linear + self._quadratic @ state + self._absolute @ np.abs(state)
        wrench = damping @ state + self._forced + self._carried(state)
        push(data, body, turn @ wrench[:3], data.xpos[body], turn @ wrench[3:])

    def _carried(self, state: Vector) -> Vector:
        """Return the Coriolis and centripetal forces and torques of the added mass, with the signs of Gazebo."""
        momentum, spin = self._coriolis[:3] * state[:3], self._coriolis[3:] * state[3:]
        force = cross(momentum, state[3:])
        torque = cross(momentum, state[:3]) + cross(spin, state[3:])
        force[0] -= 2.0 * momentum[1] * state[5]
        torque[2] += 2.0 * momentum[1] * state[0]
        return np.concatenate((force, torque))


def _table(element: Element, names: list[str]) -> Vector:
    values = [element.number(name, 0.0) for name in names]
    wrong = next((name for name, value in zip(names, values, strict=True) if not math.isfinite(value)), "")
    if wrong:
        raise element.error(f"Hydrodynamics' <{wrong}> must be finite")
    return np.array(values).reshape(6, 6)


def _answer(added: Vector, link: Link) -> tuple[Vector, Vector] | None:
    """Return the inertia (6, 6) of a link about its origin, and the inverse of its sum with an added one; None if that
    is not a mass (symmetric and not negative).
    """
    if not np.allclose(added, added.T) or np.linalg.eigvalsh(added)[0] < 0.0:
        return None
    mass, pose = link.inertial.mass, link.inertial.pose
    turn = matrix(pose.quaternion)
    x, y, z = pose.position
    lever = np.array(((0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0)))
    inertia = np.zeros((6, 6))
    inertia[:3, :3] = mass * np.eye(3)
    inertia[:3, 3:], inertia[3:, :3] = -mass * lever, mass * lever
    inertia[3:, 3:] = turn @ tensor(link.inertial.moments) @ turn.T + mass * point_inertia(pose.position)
    return inertia, np.linalg.inv(inertia + added).astype(np.float64)
