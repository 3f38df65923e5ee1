"""Forces of systems on links, and the velocities of links on which they depend.

A system whose class sets `pushes` calls `push` in `pre_update`. The forces of all systems add up and act in the next
step.

Source: https://mujoco.readthedocs.io/en/stable/APIreference/APItypes.html (mjData, xfrc_applied)
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import mujoco
import numpy as np

from gz_course.sim.gz.sim.pose import Vector

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess

_BODY = mujoco.mjtObj.mjOBJ_XBODY


def cross(one: Vector, other: Vector) -> Vector:
    """Return the cross product of two vectors (3,)."""
    result = np.zeros(3)
    mujoco.mju_cross(result, one, other)
    return result


def push(data: mujoco.MjData, body: int, force: Vector, place: Vector, torque: Vector | None = None) -> None:
    """Apply `force` [N] at the point `place` [m] and `torque` [N m] to a body, all along the axes of the world.

    The poses of the world must be up to date (`Truth.refresh`).
    """
    both = data.xfrc_applied[body]
    both[:3] += force
    # MuJoCo applies forces at the centre of mass.
    both[3:] += cross(place - data.xipos[body], force)
    if torque is not None:
        both[3:] += torque


def refresh_velocities(world: WorldAccess) -> None:
    """Bring MuJoCo's poses and velocities of bodies up to date."""
    world.truth.refresh()
    mujoco.mj_comPos(world.model, world.data)
    mujoco.mj_comVel(world.model, world.data)


def velocity(world: WorldAccess, body: int) -> tuple[Vector, Vector]:
    """Return the linear velocity [m/s] of the origin of a body and its angular velocity [rad/s], along the axes of the
    world.

    Call `refresh_velocities` first.
    """
    both = np.zeros(6)
    mujoco.mj_objectVelocity(world.model, world.data, _BODY, body, both, 0)
    return both[3:], both[:3]
