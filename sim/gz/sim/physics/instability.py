"""Finds the body that made the physics unstable.

MuJoCo detects positions, velocities, accelerations or controls that are not finite or too large, resets the state and
counts a warning. `World.step` then calls `why_unstable`.

Source: https://mujoco.readthedocs.io/en/stable/APIreference/APItypes.html (mjtWarning)
"""

from __future__ import annotations

import mujoco
import numpy as np

from gz_course.sim.gz.sim.sdf.description import WorldDescription

_WHAT = {
    mujoco.mjtWarning.mjWARN_BADQPOS: "position",
    mujoco.mjtWarning.mjWARN_BADQVEL: "velocity",
    mujoco.mjtWarning.mjWARN_BADQACC: "acceleration",
    mujoco.mjtWarning.mjWARN_BADCTRL: "command",
}
UNSTABLE = tuple(int(kind) for kind in _WHAT)
"""The numbers of MuJoCo's warnings about unstable physics."""


def why_unstable(world: WorldDescription, model: mujoco.MjModel, data: mujoco.MjData, now_ns: int) -> str:
    """Return a sentence for the error, and clear MuJoCo's warnings so that the world can continue from its start."""
    what, where = "state", ""
    for kind, word in _WHAT.items():
        warning = data.warning[int(kind)]
        if warning.number and not where:
            what, where = word, _faulty_part(model, int(kind), int(warning.lastinfo))
        warning.number = 0
    return (
        f"the physics of world '{world.name}' became unstable before {now_ns * 1e-9:.3f} s: the {what} of {where} "
        "was not finite or too large, and all bodies are back where they started; look for bodies that start inside "
        "each other, tiny masses or inertias, or a smaller max_step_size"
    )


def _faulty_part(model: mujoco.MjModel, kind: int, number: int) -> str:
    if kind == int(mujoco.mjtWarning.mjWARN_BADCTRL):
        return f"actuator '{mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_ACTUATOR, number)}'"
    starts = model.jnt_qposadr if kind == int(mujoco.mjtWarning.mjWARN_BADQPOS) else model.jnt_dofadr
    joint = int(np.searchsorted(starts, number, side="right")) - 1
    body = int(model.jnt_bodyid[joint])
    name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_BODY, body)
    through = "" if model.jnt_type[joint] == int(mujoco.mjtJoint.mjJNT_FREE) else _joint_name(model, joint)
    return f"body '{name}'{through} (mass {float(model.body_mass[body]):.3g} kg)"


def _joint_name(model: mujoco.MjModel, joint: int) -> str:
    return f" on joint '{mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT, joint)}'"
