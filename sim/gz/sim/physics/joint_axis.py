"""Joint axes in MuJoCo's arrays: position, velocity and force.

The builder makes one MuJoCo joint for each axis of a revolute, prismatic, universal, ... joint, and one with three
degrees of freedom for a ball joint. Systems that report or drive joints call `find_axes` in `bind`.

Source: https://mujoco.readthedocs.io/en/stable/XMLreference.html (body/joint)
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import mujoco
import numpy as np

from gz_course.sim.gz.sim.physics.joints import AXIS2_SUFFIX

_JOINT = mujoco.mjtObj.mjOBJ_JOINT
_BALL = int(mujoco.mjtJoint.mjJNT_BALL)


def axis_name(joint: str, axis: int) -> str:
    """Return the MuJoCo name of the first (0) or second (1) axis of a joint."""
    return joint + AXIS2_SUFFIX if axis else joint


@dataclass(frozen=True, slots=True)
class JointAxis:
    """One axis of a joint.

    `position` is its index in qpos and `velocity` its index in qvel. For a ball joint they are the first of four and of
    three, and `part` (0, 1, 2) selects the component of the rotation vector. `lower` and `upper` [rad or m] are limits.
    """

    position: int
    velocity: int
    part: int = -1
    lower: float = -math.inf
    upper: float = math.inf

    def read_position(self, data: mujoco.MjData) -> float:
        """Return the position of the axis [rad or m]."""
        if self.part < 0:
            return data.qpos.item(self.position)
        turn = np.zeros(3)
        mujoco.mju_quat2Vel(turn, data.qpos[self.position : self.position + 4], 1.0)
        return turn.item(self.part)

    def read_velocity(self, data: mujoco.MjData) -> float:
        """Return the velocity of the axis [rad/s or m/s]."""
        return data.qvel.item(self.dof)

    @property
    def dof(self) -> int:
        """The index of the axis among the degrees of freedom, as in qvel."""
        return self.velocity + max(self.part, 0)


def find_axes(model: mujoco.MjModel, name: str) -> list[JointAxis]:
    """Return the axes of the MuJoCo joint `name`; empty for a joint that is fixed, static or closes a loop."""
    found: list[JointAxis] = []
    for axis in (0, 1):
        number = int(mujoco.mj_name2id(model, _JOINT, axis_name(name, axis)))
        if number < 0:
            continue
        position, velocity = int(model.jnt_qposadr[number]), int(model.jnt_dofadr[number])
        if int(model.jnt_type[number]) == _BALL:
            return [JointAxis(position, velocity, part) for part in range(3)]
        limited = bool(model.jnt_limited[number])
        lower, upper = model.jnt_range[number].tolist() if limited else (-math.inf, math.inf)
        found.append(JointAxis(position, velocity, lower=lower, upper=upper))
    return found
