"""Pairs of collisions whose contacts differ from those of all others: tyres that skid, and shapes that bounce.

MuJoCo's friction of a geom is the same in all directions; that of a pair is not. Its axes are those of the contact,
which MuJoCo turns with the axis of a capsule on a plane, so a tyre that skids is a very short capsule.

Source: https://mujoco.readthedocs.io/en/stable/XMLreference.html (contact/pair); restitution in DART 6.13,
dart/constraint/ContactConstraint.cpp: the product of both coefficients
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import mujoco

from gz_course.sim.gz.sim.physics import recipe
from gz_course.sim.gz.sim.sdf.description import Collision, Model

MOST_BOUNCING = 200
"""Maximum number of shapes that bounce; every pair of them is an element of its own."""
_MOST_ELASTIC = 0.98
_SPINNING, _ROLLING = 0.005, 0.0001


@dataclass(frozen=True)
class Shape:
    """One geom of a collision."""

    geom: str
    part: Collision
    model: Model
    moving: bool
    skids: bool

    def touches(self, other: Shape) -> bool:
        """Return whether MuJoCo would find contacts between the two."""
        return bool(self.part.bitmask & other.part.bitmask) and (self.moving or other.moving)


def add_pairs(spec: mujoco.MjSpec, shapes: list[Shape], step: float) -> None:
    """Add the pairs of a world with steps of `step` [s]."""
    grounds = [each for each in shapes if each.part.geometry.kind == "plane" and not each.moving]
    tyres = [each for each in shapes if each.skids]
    for tyre, ground in itertools.product(tyres, grounds):
        if tyre.touches(ground) and min(tyre.part.mu, ground.part.mu) > 0.0:
            _add(spec, tyre, ground, step, sideways=recipe.SKIDDING)
    bouncing = [each for each in shapes if each.part.restitution > 0.0]
    for one, other in itertools.combinations(bouncing[:MOST_BOUNCING], 2):
        rolls = (one.skids and other in grounds) or (other.skids and one in grounds)
        if one.model is not other.model and one.touches(other) and not rolls:
            _add(spec, one, other, step, sideways=1.0)


def _add(spec: mujoco.MjSpec, one: Shape, other: Shape, step: float, sideways: float) -> None:
    friction = min(one.part.mu, other.part.mu)
    pair = spec.add_pair(name=f"{one.geom} {other.geom}", geomname1=one.geom, geomname2=other.geom)
    pair.condim = 3 if friction > 0.0 else 1
    friction = max(friction, 1e-6)
    pair.friction = (sideways * friction, friction, _SPINNING, _ROLLING, _ROLLING)
    restitution = min(one.part.restitution * other.part.restitution, _MOST_ELASTIC)
    pair.solref = recipe.bouncing_solref(step, restitution) if restitution > 0.0 else recipe.contact_solref(step)
    pair.solimp = (*recipe.CONTACT_IMPEDANCE, 0.001, 0.5, 2.0)
