"""Copies the simulation state into a rebuilt MuJoCo model after entities were added or removed.

Elements with the same name in both models keep their positions, velocities, activations, controls, applied forces,
solver warm start and time. New elements start where their model says.
"""

from __future__ import annotations

from collections.abc import Iterator

import mujoco

_POSITIONS = {int(mujoco.mjtJoint.mjJNT_FREE): 7, int(mujoco.mjtJoint.mjJNT_BALL): 4}
_VELOCITIES = {int(mujoco.mjtJoint.mjJNT_FREE): 6, int(mujoco.mjtJoint.mjJNT_BALL): 3}


def copy_state(old_model: mujoco.MjModel, old: mujoco.MjData, model: mujoco.MjModel, data: mujoco.MjData) -> None:
    """Copy the state of all elements that both models name, then compute the derived quantities."""
    for kind, before, now in _joints(old_model, model):
        p, q = int(old_model.jnt_qposadr[before]), int(model.jnt_qposadr[now])
        size = _POSITIONS.get(kind, 1)
        data.qpos[q : q + size] = old.qpos[p : p + size]
    for name in ("qvel", "qacc_warmstart", "qacc", "qfrc_applied"):
        _copy_velocities(name, old_model, old, model, data)
    for before, now in _pairs(old_model, model, mujoco.mjtObj.mjOBJ_ACTUATOR, old_model.nu, model.nu):
        data.ctrl[now] = old.ctrl[before]
        start, own = int(old_model.actuator_actadr[before]), int(model.actuator_actadr[now])
        count = min(int(old_model.actuator_actnum[before]), int(model.actuator_actnum[now]))
        if count > 0:
            data.act[own : own + count] = old.act[start : start + count]
    for before, now in _pairs(old_model, model, mujoco.mjtObj.mjOBJ_BODY, old_model.nbody, model.nbody):
        data.xfrc_applied[now] = old.xfrc_applied[before]
    for before, now in _pairs(old_model, model, mujoco.mjtObj.mjOBJ_EQUALITY, old_model.neq, model.neq):
        data.eq_active[now] = old.eq_active[before]
    data.time = old.time
    mujoco.mj_forward(model, data)
    # Sensors measure the acceleration of the last step, which `mj_forward` has overwritten.
    _copy_velocities("qacc", old_model, old, model, data)


def _copy_velocities(
    name: str, old_model: mujoco.MjModel, old: mujoco.MjData, model: mujoco.MjModel, data: mujoco.MjData
) -> None:
    source, target = getattr(old, name), getattr(data, name)
    for kind, before, now in _joints(old_model, model):
        v, w = int(old_model.jnt_dofadr[before]), int(model.jnt_dofadr[now])
        size = _VELOCITIES.get(kind, 1)
        target[w : w + size] = source[v : v + size]


def _joints(old_model: mujoco.MjModel, model: mujoco.MjModel) -> Iterator[tuple[int, int, int]]:
    """Yield (type, old id, new id) of the joints that both models have."""
    for before, now in _pairs(old_model, model, mujoco.mjtObj.mjOBJ_JOINT, old_model.njnt, model.njnt):
        kind = int(model.jnt_type[now])
        if kind == int(old_model.jnt_type[before]):
            yield kind, before, now


def _pairs(
    old_model: mujoco.MjModel, model: mujoco.MjModel, kind: mujoco.mjtObj, old_count: int, count: int
) -> Iterator[tuple[int, int]]:
    """Yield (old id, new id) of all objects of a kind that have the same name in both models."""
    numbers = {mujoco.mj_id2name(old_model, kind, number): number for number in range(old_count)}
    for number in range(count):
        name = mujoco.mj_id2name(model, kind, number)
        if name and name in numbers:
            yield numbers[name], number
