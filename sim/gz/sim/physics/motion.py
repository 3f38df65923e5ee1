"""Pose, velocity and acceleration of a MuJoCo site right after a physics step, for sensors such as IMU and altimeter.

After a step MuJoCo's derived velocities are one step old; `SiteMotion` recomputes them without changing the
simulation.

Source: https://mujoco.readthedocs.io/en/stable/APIreference/APIfunctions.html
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import mujoco
import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.pose import Quaternion, Vector, product

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess

_SITE = mujoco.mjtObj.mjOBJ_SITE


@contextmanager
def start_of_step(world: WorldAccess) -> Iterator[None]:
    """Restore MuJoCo's poses, velocities and forces at the start of the last step for the duration of the context.

    Contacts, forces and accelerations belong to that moment. The step v' = v + h a, q' = q + h v' is inverted.
    """
    world.truth.refresh()
    model, data = world.model, world.data
    qpos, qvel = data.qpos.copy(), data.qvel.copy()
    try:
        mujoco.mj_integratePos(model, data.qpos, qvel, -model.opt.timestep)
        data.qvel -= model.opt.timestep * data.qacc
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        mujoco.mj_rnePostConstraint(model, data)
        yield
    finally:
        data.qpos[:], data.qvel[:] = qpos, qvel
        mujoco.mj_kinematics(model, data)


class SiteMotion:
    """The motion of the site `name`. Raises KeyError if MuJoCo's model has no such site.

    Valid for one MuJoCo model: create a new one after every rebuild.
    """

    def __init__(self, world: WorldAccess, name: str) -> None:
        self._world = world
        site = world.model.site(name)
        self._site = int(site.id)
        self._body = int(world.model.site_bodyid[self._site])
        self._turn = site.quat.tolist()
        self._six = np.zeros(6)

    def position(self) -> Vector:
        """Return the position (3,) in the world [m]."""
        self._world.truth.refresh()
        found: Vector = self._world.data.site_xpos[self._site].copy()
        return found

    def rotation(self) -> NDArray[np.float64]:
        """Return the rotation matrix (3, 3) from the site to the world."""
        self._world.truth.refresh()
        found: NDArray[np.float64] = self._world.data.site_xmat[self._site].reshape(3, 3).copy()
        return found

    def quaternion(self) -> Vector:
        """Return the orientation (wxyz) in the world; its sign is continuous as the body turns."""
        return np.array(self.orientation())

    def orientation(self) -> Quaternion:
        """Return `quaternion` as plain floats."""
        self._world.truth.refresh()
        return product(self._world.data.xquat[self._body].tolist(), self._turn)

    def velocity(self, *, local: bool) -> tuple[Vector, Vector]:
        """Return linear [m/s] and angular [rad/s] velocity, along the axes of the site or of the world."""
        model, data = self._world.model, self._world.data
        self._world.truth.refresh()
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        mujoco.mj_objectVelocity(model, data, _SITE, self._site, self._six, local)
        return self._six[3:].copy(), self._six[:3].copy()

    def specific_force(self) -> Vector:
        """Return acceleration minus gravity (3,) [m/s^2] along the axes of the site, as an accelerometer measures it.

        Call `velocity` first: it updates the velocities used here. The acceleration is that of the last step,
        J qacc + dJ/dt qvel at the present state. With the discrete integrator qacc is exactly the change of velocity
        over the step.
        """
        model, data = self._world.model, self._world.data
        mujoco.mj_rnePostConstraint(model, data)
        mujoco.mj_objectAcceleration(model, data, _SITE, self._site, self._six, True)
        return self._six[3:].copy()

    def inertial(self) -> list[float]:
        """Return the angular velocity (3,) [rad/s] and the specific force (3,) [m/s^2] along the axes of the site."""
        _, angular = self.velocity(local=True)
        return angular.tolist() + self.specific_force().tolist()
