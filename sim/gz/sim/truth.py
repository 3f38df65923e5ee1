"""Where everything in a world really is: the questions a `World` answers, a part of it in a file of its own.

Graders, systems and sensors ask for poses and velocities by name. MuJoCo's arrays lag one step behind after a step;
`refresh` brings them up to the present.
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from gz_course.sim.gz.sim.errors import SimError, nearest
from gz_course.sim.gz.sim.physics.builder import scoped
from gz_course.sim.gz.sim.pose import Pose, Velocity, rotate
from gz_course.sim.gz.sim.sdf.description import Link, Model, WorldDescription
from gz_course.sim.gz.sim.visuals import VisualShape, visual_shapes


@dataclass(frozen=True, slots=True)
class JointAddress:
    """Where a joint lives in MuJoCo's arrays: `position` in qpos, `velocity` in qvel, `control` in ctrl (-1:
    no servo).
    """

    position: int
    velocity: int
    control: int


class Truth:
    """The methods of World that change nothing."""

    description: WorldDescription
    model: mujoco.MjModel
    data: mujoco.MjData
    iterations: int
    _models: dict[str, Model]
    _refreshed: int
    """The iteration `refresh` was last called in; -1 after the state was changed otherwise than by a step."""

    @property
    def name(self) -> str:
        """The world's name in its SDF file."""
        return self.description.name

    def _find_canonical_links(self) -> None:
        """Look up, per moving model, the body of its canonical link, and the model frame seen from it."""
        self._canonical: dict[str, tuple[int, Pose]] = {}
        for model in self.description.models:
            canonical = model.link(model.canonical_link)
            if canonical is None or model.static:
                continue
            body = mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_BODY, scoped(model, canonical.name))
            if body >= 0:
                self._canonical[model.name] = (body, canonical.pose.inverse())

    def refresh(self) -> None:
        """Bring MuJoCo's world poses (`data.xpos`, `site_xpos`, ...) up to the present; a step leaves them
        one step behind.
        """
        if self._refreshed != self.iterations:
            mujoco.mj_kinematics(self.model, self.data)
            self._refreshed = self.iterations

    def model_names(self, *, static: bool = False) -> list[str]:
        """Return the names of the models that can move, in file order; with `static` those that cannot come
        after.
        """
        moving = [model.name for model in self.description.models if not model.static]
        return moving + [model.name for model in self.description.models if model.static] if static else moving

    def pose(self, model: str) -> Pose:
        """Return where the frame of a model, or of a model in it (`arm::hand`), is now, in the world frame; raise
        `SimError` for an unknown model.
        """
        owner, _, inner = model.partition("::")
        if inner and owner in self._models:
            return self._nested_pose(self._models[owner], inner)
        found = self._model(model)
        if model not in self._canonical:
            return found.pose
        body, link_model = self._canonical[model]
        self.refresh()
        return Pose(self.data.xpos[body], self.data.xquat[body]) * link_model

    def link_pose(self, model: str, link: str) -> Pose:
        """Return where a link's frame is now, in the world frame; raise `SimError` for an unknown model or
        link.
        """
        found = self._model(model)
        return self._link_pose(found, self._link(found, link))

    def velocity(self, model: str) -> Velocity:
        """Return the velocity of the model's frame (m/s, rad/s, world axes); raise `SimError` for an unknown
        model.
        """
        self._model(model)
        if model not in self._canonical:
            return Velocity(np.zeros(3), np.zeros(3))
        self.refresh()
        mujoco.mj_comPos(self.model, self.data)
        mujoco.mj_comVel(self.model, self.data)
        body, link_model = self._canonical[model]
        both = np.zeros(6)
        mujoco.mj_objectVelocity(self.model, self.data, mujoco.mjtObj.mjOBJ_XBODY, body, both, 0)
        angular, linear = both[:3].copy(), both[3:].copy()
        offset = rotate(self.data.xquat[body], link_model.position)
        lever = np.zeros(3)
        mujoco.mju_cross(lever, angular, offset)
        return Velocity(linear + lever, angular)

    def geometry(self) -> list[VisualShape]:
        """Return every visible shape of the world, fixed to its link."""
        return visual_shapes(self.description)

    def joint_address(self, model: Model, joint: str) -> JointAddress:
        """Return where a joint (scoped name) of a moving model lives in MuJoCo's arrays."""
        name = scoped(model, joint)
        found = self.model.joint(name)
        control = mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_ACTUATOR, name)
        return JointAddress(int(found.qposadr[0]), int(found.dofadr[0]), control)

    def _nested_pose(self, model: Model, name: str) -> Pose:
        nested = next((each for each in model.nested if each.name == name), None)
        if nested is None:
            hint = nearest(name, [each.name for each in model.nested], listing="its models are")
            raise SimError(f"model '{model.name}' has no model '{name}'; {hint}")
        canonical = model.link(nested.canonical_link)
        if canonical is None:
            return self.pose(model.name) * nested.pose
        return self._link_pose(model, canonical) * canonical.pose.inverse() * nested.pose

    def _model(self, name: str) -> Model:
        found = self._models.get(name)
        if found is None:
            hint = nearest(name, self._models, listing="its models are")
            raise SimError(f"world '{self.name}' has no model '{name}'; {hint}")
        return found

    @staticmethod
    def _link(model: Model, name: str) -> Link:
        found = model.link(name)
        if found is None:
            hint = nearest(name, [each.name for each in model.links], listing="its links are")
            raise SimError(f"model '{model.name}' has no link '{name}'; {hint}")
        return found

    def _link_pose(self, model: Model, link: Link) -> Pose:
        body = mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_BODY, scoped(model, link.name))
        if body < 0:  # held by the world
            return model.pose * link.pose
        self.refresh()
        return Pose(self.data.xpos[body], self.data.xquat[body])
