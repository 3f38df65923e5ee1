"""Joints that systems drive: each becomes a MuJoCo actuator whose control a system writes before every step.

A system says in `System.servos` which joints it wants; the builder adds the actuators with `add_servo`; the
system finds its place in `data.ctrl` with `World.joint_address`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import mujoco

from gz.sim.physics import recipe
from gz.sim.sdf.description import UNLIMITED, Model

WHEEL = "wheel"
VELOCITY = "velocity"


@dataclass(frozen=True)
class JointServo:
    """A system's wish to drive a joint by velocity: `joint` (scoped name), `kind`, wheel `radius` (m),
    `sharing` wheels, `effort` (N m or N) as the most it may push.
    """

    joint: str
    kind: str = VELOCITY
    radius: float = 0.0
    sharing: int = 1
    effort: float = math.inf


def add_servo(spec: mujoco.MjSpec, model: Model, servo: JointServo, name: str) -> None:
    """Add the actuator of a servo; `name` is the MuJoCo name of the joint and becomes the actuator's."""
    joint = model.joint(servo.joint)
    assert joint is not None
    if servo.kind == WHEEL:
        gain = recipe.wheel_gain(model.mass(), servo.sharing, servo.radius)
    else:
        child = model.link(joint.child)
        assert child is not None
        gain = 100.0 * child.inertial.mass
    actuator = spec.add_actuator(name=name, target=name)
    actuator.trntype = mujoco.mjtTrn.mjTRN_JOINT
    actuator.set_to_velocity(kv=gain)
    effort = min(servo.effort, joint.axis.effort if joint.axis is not None else math.inf)
    if 0.0 < effort < UNLIMITED:
        actuator.forcelimited = mujoco.mjtLimited.mjLIMITED_TRUE
        actuator.forcerange = (-effort, effort)
