"""Pairs of collisions whose contacts differ from those of all others: what moves on the ground, tyres that skid, rigid
casters, and shapes that bounce.

MuJoCo's friction of a geom is the same in all directions, and takes away sliding as fast as the contact takes away
depth; that of a pair is not. Its axes are those of the contact, which MuJoCo turns with the axis of a capsule on a
plane, so a tyre that skids is a very short capsule.

Source: https://mujoco.readthedocs.io/en/stable/XMLreference.html (contact/pair); restitution in DART 6.13,
dart/constraint/ContactConstraint.cpp: the product of both coefficients
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import mujoco

from gz_course.sim.gz.sim.physics import recipe
from gz_course.sim.gz.sim.sdf.description import Collision, Model
from gz_course.sim.gz.sim.sdf.tyres import Tyre

MOST_ON_GROUND = 1000
"""Maximum number of moving shapes with a contact of their own with the ground; every pair is an element of its own."""
MOST_DRAGGED_OVER = 200
"""Maximum number of fixed shapes on which rigid casters slide."""
MOST_BOUNCING = 200
"""Maximum number of shapes that bounce; every pair of them is an element of its own."""
_MOST_ELASTIC = 0.98
_FILM = 0.001
"""Friction across a tyre that slips, relative to that along it."""
_SPINNING, _ROLLING = 0.005, 0.0001


@dataclass(frozen=True)
class Shape:
    """One geom of a collision. A `tyre` has other friction across than along it on a plane. One that `drags` is a rigid
    caster of a robot with driven wheels.
    """

    geom: str
    part: Collision
    model: Model
    moving: bool
    tyre: Tyre | None = None
    drags: bool = False

    def touches(self, other: Shape) -> bool:
        """Return whether MuJoCo would find contacts between the two."""
        return bool(self.part.bitmask & other.part.bitmask) and (self.moving or other.moving)


def add_pairs(spec: mujoco.MjSpec, shapes: list[Shape], step: float) -> None:
    """Add the pairs of a world with steps of `step` [s]."""
    fixed = [each for each in shapes if not each.moving]
    moving = [each for each in shapes if each.moving]
    grounds = [each for each in fixed if _is_ground(each)]
    for one, ground in itertools.product(moving[:MOST_ON_GROUND], grounds):
        rolls = one.tyre is not None and ground.part.geometry.kind == "plane" and ground.part.mu > 0.0
        if one.touches(ground) and (rolls or not _bounce(one, ground)):
            _add_sliding(spec, one, ground, step, one.tyre if rolls else None)
    others = [each for each in fixed if each not in grounds][:MOST_DRAGGED_OVER]
    for caster, other in itertools.product((each for each in moving if _drags(each)), others):
        if caster.touches(other) and not _bounce(caster, other):
            _add_sliding(spec, caster, other, step)
    bouncing = [each for each in shapes if each.part.restitution > 0.0]
    for one, other in itertools.combinations(bouncing[:MOST_BOUNCING], 2):
        rolls = bool((one.tyre and other in grounds) or (other.tyre and one in grounds))
        if one.model is not other.model and one.touches(other) and not rolls:
            restitution = min(one.part.restitution * other.part.restitution, _MOST_ELASTIC)
            pair = _add(spec, one, other)
            pair.solref = recipe.bouncing_solref(step, restitution)
            pair.solimp[:2] = recipe.CONTACT_IMPEDANCE


def _is_ground(shape: Shape) -> bool:
    """Tell whether bodies stand on a fixed shape: a plane or a heightmap."""
    return shape.part.geometry.kind == "plane" or shape.part.geometry.heights is not None


def _bounce(one: Shape, other: Shape) -> bool:
    return one.part.restitution * other.part.restitution > 0.0


def _drags(shape: Shape) -> bool:
    return shape.drags and shape.part.mu > recipe.SLIPPERY


def _add_sliding(spec: mujoco.MjSpec, one: Shape, ground: Shape, step: float, tyre: Tyre | None = None) -> None:
    """Add a contact that slides without hops."""
    pair = _add(spec, one, ground)
    if tyre is not None:
        across, along = (max(min(mu, ground.part.mu), 1e-6) for mu in (tyre.across, tyre.along))
        # What slips is held by the forces of `driving/tyre_slip.py`.
        pair.friction[:2] = (_FILM * min(across, along) if tyre.slip else across), along
        pair.condim = 3
    drags = _drags(one) and ground.part.mu > recipe.SLIPPERY
    pair.solref, pair.solimp[:2] = recipe.ground_solref(step), recipe.ground_impedance(step)
    pair.solreffriction = recipe.friction_solref(recipe.DRAGGING if drags else recipe.gripping(step))


def _add(spec: mujoco.MjSpec, one: Shape, other: Shape) -> mujoco.MjsPair:
    friction = min(one.part.mu, other.part.mu)
    pair = spec.add_pair(name=f"{one.geom} {other.geom}", geomname1=one.geom, geomname2=other.geom)
    pair.condim = 3 if friction > 0.0 else 1
    friction = max(friction, 1e-6)
    pair.friction = (friction, friction, _SPINNING, _ROLLING, _ROLLING)
    return pair
