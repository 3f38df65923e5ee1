"""Dragging a link with the mouse or keys: a force while the world runs, another pose while it is paused.

Studio picks the link (double click) and moves the point it is drawn to (Ctrl and a mouse button); MuJoCo makes a force
or a pose of it.

Source: https://mujoco.readthedocs.io/en/stable/APIreference/APIfunctions.html#mjv-applyperturbforce
"""

from __future__ import annotations

import time

import mujoco
import numpy as np

from gz_course.sim.gz.view.entities import link_of_body
from gz_course.sim.gz.view.world_link import WorldLink

_PERIOD_S = 0.03
"""Shortest time [s] between two messages."""
_PUSH, _TURN = 8.0, 2.0
"""Force [N] and torque [N m] of the keys, for each kilogram of the model."""
_STEP, _ANGLE = 0.02, 0.03
"""Way [m] and angle [rad] that the keys move a model of a paused world with each message."""


class Dragging:
    """What the mouse does to the selected link, sent to the world."""

    def __init__(self, link: WorldLink) -> None:
        self._link = link
        self._pushed = ""
        self._next = 0.0

    def update(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        perturb: mujoco.MjvPerturb,
        along: np.ndarray,
        *,
        paused: bool,
    ) -> None:
        """Send the drag of this picture, if there is one; `along` is that of the keys, as `Keyboard.push_along`."""
        name = link_of_body(model, perturb.select) if perturb.active or along.any() else ""
        if self._pushed and (paused or name != self._pushed):
            self._link.drag(self._pushed, np.zeros(6))
            self._pushed = ""
        if not name or time.monotonic() < self._next:
            return
        self._next = time.monotonic() + _PERIOD_S
        if paused:
            self._move(model, data, perturb, along)
            return
        data.xfrc_applied[:] = 0.0
        if perturb.active:
            mujoco.mjv_applyPerturbForce(model, data, perturb)
        else:
            x, y, turn = along * model.body_subtreemass[model.body_rootid[perturb.select]]
            data.xfrc_applied[perturb.select] = (_PUSH * x, _PUSH * y, 0.0, 0.0, 0.0, _TURN * turn)
        self._link.drag(name, data.xfrc_applied[perturb.select])
        self._pushed = name

    def _move(self, model: mujoco.MjModel, data: mujoco.MjData, perturb: mujoco.MjvPerturb, along: np.ndarray) -> None:
        root = int(model.body_rootid[perturb.select])
        joint = int(model.body_jntadr[root])
        if joint < 0 or int(model.jnt_type[joint]) != int(mujoco.mjtJoint.mjJNT_FREE):
            self._link.said = f"'{link_of_body(model, root)}' is held by a joint, so it can be dragged while time runs"
            return
        q = int(model.jnt_qposadr[joint])
        if perturb.active:
            mujoco.mjv_applyPerturbPose(model, data, perturb, 1)
        else:
            data.qpos[q : q + 2] += _STEP * along[:2]
            half, turned = _ANGLE * along[2] / 2.0, np.zeros(4)
            mujoco.mju_mulQuat(turned, np.array([np.cos(half), 0.0, 0.0, np.sin(half)]), data.qpos[q + 3 : q + 7])
            data.qpos[q + 3 : q + 7] = turned
        self._link.set_pose(link_of_body(model, root), data.qpos[q : q + 3], data.qpos[q + 3 : q + 7])
