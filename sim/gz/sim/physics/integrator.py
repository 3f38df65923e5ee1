"""The integrator of a world, chosen when its model is compiled.

Worlds with servos need an integrator that is implicit in velocity: `discrete`, or `implicitfast` where shapes bounce,
because `discrete` takes energy out of a contact. Sensors of forces and accelerations reckon back to the start of the
step, which only these two allow. Both are of first order: a tumbling body loses 2 % of its energy in 10 s at steps of
1 ms, a double pendulum a quarter in 30 s. Worlds of few bodies without servos, sensors, and strong springs and dampers
are integrated by the Runge-Kutta method of fourth order, which loses less than 0.01 %, in four times the processor
time.

Source: https://mujoco.readthedocs.io/en/stable/computation/index.html (numerical integration)
"""

from __future__ import annotations

import mujoco
import numpy as np

MOST_BODIES = 50
"""Maximum number of moving bodies of a world whose steps may take four times as long."""
_STIFF = 0.05  # change of a velocity by a damper or spring in one step, relative to the velocity


def choose(model: mujoco.MjModel) -> None:
    """Set the integrator of a compiled model to Runge-Kutta if that is stable."""
    moving = int((model.body_weldid > 0).sum())
    if 0 < moving <= MOST_BODIES and not (model.nsite or _is_servoed(model) or _is_stiff(model)):
        model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4


def _is_servoed(model: mujoco.MjModel) -> bool:
    return bool((model.actuator_biastype != int(mujoco.mjtBias.mjBIAS_NONE)).any())


def _is_stiff(model: mujoco.MjModel) -> bool:
    step, inverse = float(model.opt.timestep), model.dof_invweight0
    damping = np.abs(model.dof_damping).reshape(model.nv, -1).sum(axis=1)
    stiffness = np.abs(model.jnt_stiffness).reshape(model.njnt, -1).sum(axis=1)[model.dof_jntid]
    return bool((damping * inverse * step > _STIFF).any() or (stiffness * inverse * step * step > _STIFF).any())
