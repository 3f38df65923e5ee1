"""How a point fixed to a body stands and moves right after a physics step: MuJoCo's answers for one site.

Used by the sensors that stand at one place (IMU, altimeter, ...). A step leaves MuJoCo's velocities one step behind;
`SiteMotion` brings them up to the present, which costs a few microseconds and changes nothing in the simulation.

Source: https://mujoco.readthedocs.io/en/stable/APIreference/APIfunctions.html
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import mujoco
import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.pose import Vector, multiply

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess

_SITE = mujoco.mjtObj.mjOBJ_SITE


@contextmanager
def start_of_step(world: WorldAccess) -> Iterator[None]:
    """Look at MuJoCo's places, velocities and forces as they were when the last step began: the moment whose contacts,
    forces and accelerations belong together. Everything is as before afterwards.

    The step went v' = v + h a, then q' = q + h v'; it is gone back the same way.
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
    """The motion of the site called `name`; raises KeyError when MuJoCo's model has no such site.

    Bound to one MuJoCo model: make a new one after every rebuild.
    """

    def __init__(self, world: WorldAccess, name: str) -> None:
        self._world = world
        site = world.model.site(name)
        self._site = int(site.id)
        self._body = int(world.model.site_bodyid[self._site])
        self._turn: Vector = np.array(site.quat)
        self._six = np.zeros(6)

    def position(self) -> Vector:
        """Return the position (3,) in the world (m)."""
        self._world.truth.refresh()
        found: Vector = self._world.data.site_xpos[self._site].copy()
        return found

    def rotation(self) -> NDArray[np.float64]:
        """Return the matrix (3, 3) that turns the site's coordinates into the world's."""
        self._world.truth.refresh()
        found: NDArray[np.float64] = self._world.data.site_xmat[self._site].reshape(3, 3).copy()
        return found

    def quaternion(self) -> Vector:
        """Return the orientation (wxyz) in the world; its sign does not jump as the body turns."""
        self._world.truth.refresh()
        return multiply(self._world.data.xquat[self._body], self._turn)

    def velocity(self, *, local: bool) -> tuple[Vector, Vector]:
        """Return linear (m/s) and angular velocity (rad/s), along the site's own axes or the world's."""
        model, data = self._world.model, self._world.data
        self._world.truth.refresh()
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        mujoco.mj_objectVelocity(model, data, _SITE, self._site, self._six, local)
        return self._six[3:].copy(), self._six[:3].copy()

    def specific_force(self) -> Vector:
        """Return acceleration minus gravity (3,) along the site's own axes (m/s^2): what an accelerometer shows.

        Uses the velocities `velocity` brought up to date, so ask for them first. The acceleration is that of the
        step just done: J qacc + dJ/dt qvel at the present state. With the discrete integrator qacc is exactly
        the change of velocity over the step.
        """
        model, data = self._world.model, self._world.data
        mujoco.mj_rnePostConstraint(model, data)
        mujoco.mj_objectAcceleration(model, data, _SITE, self._site, self._six, True)
        return self._six[3:].copy()
