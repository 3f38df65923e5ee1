"""Welds between links of different models, which systems attach and detach while the world runs.

`System.welds` returns what a system may weld, `add_welds` adds an inactive constraint for each pair of links that
exist, and `System.bind` looks it up with `find_weld`.

Source: https://mujoco.readthedocs.io/en/stable/XMLreference.html (equality/weld)
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from gz_course.sim.gz.sim.physics import recipe
from gz_course.sim.gz.sim.pose import Pose, Vector
from gz_course.sim.gz.sim.sdf.description import WorldDescription


@dataclass(frozen=True)
class WeldRequest:
    """A pair of links (`model::link`); the first of `children` that exists is the child."""

    name: str
    parent: str
    children: tuple[str, ...]


def add_welds(spec: mujoco.MjSpec, world: WorldDescription, requests: dict[str, list[WeldRequest]]) -> None:
    """Add the constraints of all requests whose links exist, to the spec of a world."""
    bodies = {
        f"{model.name}::{link.name}": "world" if model.static else f"{model.name}::{link.name}"
        for model in (world.models if any(requests.values()) else ())
        for link in model.links
    }
    for request in (each for of_model in requests.values() for each in of_model):
        child = next((link for link in request.children if link in bodies), "")
        if not child or request.parent not in bodies or bodies[child] == bodies[request.parent]:
            continue
        weld = spec.add_equality(
            name=request.name,
            type=mujoco.mjtEq.mjEQ_WELD,
            objtype=mujoco.mjtObj.mjOBJ_BODY,
            name1=bodies[request.parent],
            name2=bodies[child],
            active=False,
        )
        weld.solref = recipe.contact_solref(world.step_size_ns * 1e-9)


class Weld:
    """A constraint of the compiled model. Valid for one MuJoCo model: find it again after every rebuild."""

    def __init__(self, model: mujoco.MjModel, number: int) -> None:
        self._model = model
        self._number = number
        self._bodies = (int(model.eq_obj1id[number]), int(model.eq_obj2id[number]))

    def relative_pose(self, data: mujoco.MjData) -> Pose:
        """Return the pose of the child's body in that of the parent, which must be up to date in `data`."""
        parent, child = (Pose(data.xpos[body].copy(), data.xquat[body].copy()) for body in self._bodies)
        return parent.inverse() * child

    def hold(self, data: mujoco.MjData, pose: Pose) -> None:
        """Hold the child's body at `pose` in the parent's."""
        numbers: Vector = self._model.eq_data[self._number]
        numbers[:10] = np.concatenate((np.zeros(3), pose.position, pose.quaternion))
        data.eq_active[self._number] = 1

    def let_go(self, data: mujoco.MjData) -> None:
        data.eq_active[self._number] = 0


def find_weld(model: mujoco.MjModel, name: str) -> Weld | None:
    """Find the constraint of a request; None if its links do not exist."""
    number = int(mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_EQUALITY, name))
    return Weld(model, number) if number >= 0 else None
