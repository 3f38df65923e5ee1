"""Bodies that sleep: in a large world, bodies that lie still are not computed until something moves them.

Only free bodies sleep: models without joints, sensors and plugins. A force, a velocity, a new pose and a touch of what
moves wake them, and a rebuilt world is awake. A body that sleeps has no contacts, so nobody sleeps where something
static looks at contacts or moves what lies on it: a sensor or a plugin of a static model.

Source: https://mujoco.readthedocs.io/en/stable/computation/index.html (sleeping islands)
"""

from __future__ import annotations

import mujoco

from gz_course.sim.gz.sim.sdf.description import Model, WorldDescription

FEWEST = 300
"""Number of bodies from which a world lets its bodies sleep; smaller ones compute every body in every step."""
_STILL = 1e-4
"""Speed [m/s, and per size of the body rad/s] below which a body is still; Gazebo has no such limit."""


def allow(model: mujoco.MjModel, data: mujoco.MjData, world: WorldDescription) -> None:
    """Let the free bodies of a large world, compiled just now, sleep; other worlds stay as they are."""
    few = model.ntree < FEWEST or model.opt.integrator == int(mujoco.mjtIntegrator.mjINT_RK4)
    if few or any(each.static and _watches(each) for each in world.models):
        return
    free = {each.name for each in world.models if not each.static and not each.joints and not _watches(each)}
    free -= {end.partition("::")[0] for joint in world.joints for end in (joint.parent, joint.child)}
    policy = mujoco.mjtSleepPolicy
    for tree in range(model.ntree):
        body = int(model.dof_bodyid[model.tree_dofadr[tree]])
        owner = (mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_BODY, body) or "").partition("::")[0]
        model.tree_sleep_policy[tree] = int(policy.mjSLEEP_ALLOWED if owner in free else policy.mjSLEEP_NEVER)
    if (model.tree_sleep_policy == int(policy.mjSLEEP_ALLOWED)).any():
        model.opt.sleep_tolerance = _STILL
        model.opt.enableflags |= int(mujoco.mjtEnableBit.mjENBL_SLEEP)
        mujoco.mj_resetData(model, data)  # as created, and awake


def _watches(model: Model) -> bool:
    """Tell whether a model has sensors or plugins."""
    return bool(model.plugins or model.sensors())
