"""Tyres that slip: across its `fdir1` a wheel gives way to a force, with `slip1` times that force.

MuJoCo has no such friction, so the force is applied to the wheel: the velocity across divided by the slip, and no more
than friction allows. The load is that of the last step.

Source: https://github.com/dartsim/dart/blob/v6.12.2/dart/constraint/ContactConstraint.cpp (slip compliance)
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from gz_course.sim.gz.sim.physics.contacts import CollisionGeoms
from gz_course.sim.gz.sim.physics.pushes import refresh_velocities
from gz_course.sim.gz.sim.pose import Vector, rotate
from gz_course.sim.gz.sim.sdf.description import Collision, Model
from gz_course.sim.gz.sim.sdf.tyres import read_tyre, wheels

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess

_PLANE = int(mujoco.mjtGeom.mjGEOM_PLANE)


@dataclass(frozen=True, slots=True)
class _Slipping:
    """A geom of a tyre that slips: its body, the root of that, the axle in the frame of the body, friction across and
    slip [m/(N s)].
    """

    body: int
    root: int
    axle: Vector
    across: float
    slip: float


class TyreSlip:
    """The tyres of one model that slip; `push` acts in the next step."""

    def __init__(self, world: WorldAccess, model: Model) -> None:
        """Find the collisions of driven wheels that state a slip across."""
        self._world, self._model = world, model
        self._parts: list[tuple[Collision, Vector, float]] = []
        for part, axle in wheels(model):
            tyre = read_tyre(part, axle)
            if tyre is not None and tyre.slip > 0.0:
                self._parts.append((part, axle, tyre.slip))
        self._geoms: dict[int, _Slipping] = {}

    @property
    def active(self) -> bool:
        """Whether there is any, so that `push` is to be called before each step."""
        return bool(self._parts)

    def bind(self) -> None:
        """Find the geoms in MuJoCo's model, which was just built."""
        if not self._parts:
            return
        model, shapes = self._world.model, CollisionGeoms(self._world)
        mass = self._model.mass() / len(self._parts)
        self._geoms = {}
        self._planes = frozenset(np.flatnonzero(model.geom_type == _PLANE).tolist())
        for part, axle, slip in self._parts:
            link = next(link for link in self._model.links if part in link.collisions)
            # Here a tyre touches a plane at two points. In Gazebo a cylinder does, too, and a sphere at one.
            slip *= 2.0 if part.geometry.kind == "sphere" else 1.0
            # Less slip than this is more than a force of the last step can hold.
            least = 4.0 * float(model.opt.timestep) / mass
            for geom in shapes.of((self._model.name, link.name, part.name)):
                body = int(model.geom_bodyid[geom])
                root, along = int(model.body_rootid[body]), axle / np.linalg.norm(axle)
                self._geoms[geom] = _Slipping(body, root, along, part.mu, max(slip, least))

    def push(self) -> None:
        """Push each tyre that touches a plane against the direction in which it slips."""
        refresh_velocities(self._world)
        data, contacts = self._world.data, self._world.data.contact
        loads = data.efc_force.tolist()  # friction is a cone: the first row of a contact is its load
        rows = zip(
            contacts.geom.tolist(),
            contacts.efc_address.tolist(),
            contacts.pos.tolist(),
            contacts.frame[:, :3].tolist(),
            strict=True,
        )
        moving: dict[int, tuple[list[float], list[float], list[float], list[float]]] = {}
        for (one, other), row, (x, y, z), (i, j, k) in rows:
            tyre = self._geoms.get(one) or self._geoms.get(other)
            if tyre is None or row < 0 or (other if one in self._geoms else one) not in self._planes:
                continue
            body = tyre.body
            if body not in moving:
                centre = data.subtree_com[tyre.root].tolist()
                axle = rotate(data.xquat[body], tyre.axle).tolist()
                moving[body] = axle, data.cvel[body].tolist(), centre, data.xipos[body].tolist()
            (p, q, r), (u, v, w, *linear), (a, b, c), (e, f, g) = moving[body]
            aside = p * i + q * j + r * k
            p, q, r = p - aside * i, q - aside * j, r - aside * k  # the axle along the plane
            length = math.sqrt(p * p + q * q + r * r) or 1.0
            a, b, c = x - a, y - b, z - c
            speed = p * (linear[0] + v * c - w * b) + q * (linear[1] + w * a - u * c) + r * (linear[2] + u * b - v * a)
            most = tyre.across * max(0.0, loads[row])
            force = -min(max(speed / length / tyre.slip, -most), most) / length
            p, q, r = force * p, force * q, force * r
            e, f, g = x - e, y - f, z - g  # MuJoCo applies forces at the centre of mass
            data.xfrc_applied[body] += (p, q, r, f * r - g * q, g * p - e * r, e * q - f * p)
