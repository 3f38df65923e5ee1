"""Contacts with surfaces that move along their own shape: belts of tracks, conveyors, rollers of mecanum wheels.

MuJoCo's friction brings the velocity of two touching shapes towards each other, within the friction cone. Between the
two halves of a step (`System.in_step`) `move` shifts the velocity that friction aims at.

Source: https://mujoco.readthedocs.io/en/stable/computation/index.html (constraint model, reference acceleration)
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import TYPE_CHECKING

import mujoco

from gz_course.sim.gz.sim.physics import recipe
from gz_course.sim.gz.sim.physics.joint_axis import find_axes
from gz_course.sim.gz.sim.physics.servos import WHEEL
from gz_course.sim.gz.sim.pose import Vector

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess

Motion = Callable[[int, Vector, Vector], Vector]
"""Takes a geom, a point of it [m] and the normal that points into it, and returns a velocity [m/s]; world axes."""


def prepare(world: WorldAccess) -> None:
    """Choose the integrator `implicitfast`, with which alone `move` works, and give wheels the rotor and the softer
    servo that it needs.
    """
    model = world.model
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    for owner in world.description.models:
        for servo in world.systems.servos.get(owner.name, []):
            if servo.kind == WHEEL:
                armature = recipe.wheel_armature(owner.mass(), servo.sharing, servo.radius)
                for axis in find_axes(model, f"{owner.name}::{servo.joint}"):
                    model.dof_armature[axis.velocity] = armature
                actuator = model.actuator(f"{owner.name}::{servo.actuator}")
                gain = recipe.wheel_gain(owner.mass(), servo.sharing, servo.radius, soft=True)
                actuator.gainprm[0], actuator.biasprm[2] = gain, -gain


def move(world: WorldAccess, geoms: Collection[int], motion: Motion) -> None:
    """Let each of `geoms` slide on what it touches with the velocity `motion`, as far as friction can make it.

    Contacts between two of the geoms stay as they are.
    """
    data = world.data
    contacts = data.contact
    pairs, rows, sizes = contacts.geom.tolist(), contacts.efc_address.tolist(), contacts.dim.tolist()
    for index, ((one, other), row, size) in enumerate(zip(pairs, rows, sizes, strict=True)):
        mine = one in geoms
        if mine == (other in geoms) or row < 0 or size < 3:
            continue
        frame = contacts.frame[index].reshape(3, 3)
        # MuJoCo's normal points from the first geom to the second; the velocity is that of the second.
        sign = -1.0 if mine else 1.0
        wanted = sign * motion(one if mine else other, contacts.pos[index], sign * frame[0])
        for axis in (1, 2):
            damping = data.efc_KBIP[row + axis, 1]
            data.efc_aref[row + axis] += damping * float(wanted @ frame[axis])
