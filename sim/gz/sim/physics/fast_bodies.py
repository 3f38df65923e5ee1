"""Free bodies that move so far in a step that they could pass through thin walls.

While one does, MuJoCo looks for the contacts on its way (speculative contacts), which takes a sixth of the time of a
step. It does so only in the integrators of first order, so a world that is integrated by Runge-Kutta has such a one
meanwhile.

Source: https://mujoco.readthedocs.io/en/stable/computation/speculative.html
"""

from __future__ import annotations

import mujoco
import numpy as np

from gz_course.sim.gz.sim.physics.geoms import COLLISION_GROUP

_FAR = 0.5  # way in a step, relative to half the least thickness of the body
_SPECULATIVE = int(mujoco.mjtEnableBit.mjENBL_SPECULATIVE)
_RK4, _IMPLICITFAST = int(mujoco.mjtIntegrator.mjINT_RK4), int(mujoco.mjtIntegrator.mjINT_IMPLICITFAST)


class FastBodies:
    """The free bodies of one compiled model; `watch` is called before each step if there are any."""

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self._option, self._usual = model.opt, 0
        self._fast = False
        self._qvel = data.qvel  # a view, because making one takes as long as using it
        self._bodies = list(_squared_limits(model))

    @property
    def active(self) -> bool:
        """Whether there are free bodies."""
        return bool(self._bodies)

    def watch(self) -> None:
        """Prepare the next step for the present velocities."""
        qvel = self._qvel.item
        fast = False
        for first, most in self._bodies:
            x, y, z = qvel(first), qvel(first + 1), qvel(first + 2)
            if x * x + y * y + z * z > most:
                fast = True
                break
        if fast is not self._fast:
            self._fast = fast
            self._switch()

    def _switch(self) -> None:
        option = self._option
        if self._fast:
            self._usual = int(option.integrator)
            option.enableflags |= _SPECULATIVE
            option.integrator = _IMPLICITFAST if self._usual == _RK4 else self._usual
        else:
            option.enableflags &= ~_SPECULATIVE
            option.integrator = self._usual


def _squared_limits(model: mujoco.MjModel) -> list[tuple[int, float]]:
    """Return, for each free body with collisions, its first degree of freedom and the square of the velocity [m/s] from
    which it is fast.
    """
    found = []
    for joint in np.flatnonzero(model.jnt_type == int(mujoco.mjtJoint.mjJNT_FREE)).tolist():
        geoms = np.flatnonzero((model.geom_bodyid == model.jnt_bodyid[joint]) & (model.geom_group == COLLISION_GROUP))
        if len(geoms):
            half = float(model.geom_aabb[geoms, 3:].min())
            found.append((int(model.jnt_dofadr[joint]), (_FAR * half / float(model.opt.timestep)) ** 2))
    return found
