"""The true state of a world: poses and velocities by name, visible shapes, and indices of joints in MuJoCo's arrays.

MuJoCo computes world poses at the beginning of a step, so they are one step old after it; `refresh` updates them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.errors import SimError
from gz_course.sim.gz.sim.physics.builder import scoped
from gz_course.sim.gz.sim.pose import Pose, Velocity, product, rotate, rotated
from gz_course.sim.gz.sim.sdf.description import Link, Model, WorldDescription
from gz_course.sim.gz.sim.visuals import VisualShape, visual_shapes


@dataclass(frozen=True, slots=True)
class JointAddress:
    """The indices of a joint: `position` in qpos, `velocity` in qvel, `control` in ctrl (-1 without a servo)."""

    position: int
    velocity: int
    control: int


class Truth:
    """The present poses and velocities of the models and links of one world.

    Raises SimError with the nearest name for an unknown model or link.
    """

    model: mujoco.MjModel
    data: mujoco.MjData

    def __init__(self, description: WorldDescription) -> None:
        self._description = description
        self._canonical: dict[str, tuple[int, Pose]] = {}
        self.models = {model.name: model for model in description.models}
        """The models by name; `Editor` updates it together with the description."""
        self.stale = True
        """True if MuJoCo's world poses may be out of date; set by every change of the state."""

    def bind(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Set MuJoCo's new model and data.

        For each moving model, look up the body of its canonical link and the pose of the model's frame in that link.
        """
        self.model, self.data, self.stale = model, data, True
        self._canonical.clear()
        for each in self._description.models:
            canonical = each.link(each.canonical_link)
            if canonical is None or each.static:
                continue
            body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, scoped(each, canonical.name))
            if body >= 0:
                self._canonical[each.name] = (body, canonical.pose.inverse())

    def refresh(self) -> None:
        """Update MuJoCo's world poses (`data.xpos`, `site_xpos`, ...) if they are out of date."""
        if self.stale:
            mujoco.mj_kinematics(self.model, self.data)
            self.stale = False

    def model_names(self, *, static: bool = False) -> list[str]:
        """Return the names of the models that can move, in file order; `static` appends those of the static ones."""
        moving = [model.name for model in self._description.models if not model.static]
        return moving + [model.name for model in self._description.models if model.static] if static else moving

    def pose(self, model: str) -> Pose:
        """Return the pose of a model, or of a model nested in it (`arm::hand`), in the world frame."""
        owner, _, inner = model.partition("::")
        if inner and owner in self.models:
            return self._nested_pose(self.models[owner], inner)
        found = self.find_model(model)
        if model not in self._canonical:
            return found.pose
        body, link_model = self._canonical[model]
        self.refresh()
        return Pose(self.data.xpos[body], self.data.xquat[body]) * link_model

    def pose_in_floats(self, model: str) -> tuple[Sequence[float], Sequence[float]]:
        """Return the position [m] and quaternion (wxyz) of `pose`, without arrays, for what is sent in every step."""
        if model not in self._canonical:
            pose = self.pose(model)
            return pose.position.tolist(), pose.quaternion.tolist()
        body, link_model = self._canonical[model]
        self.refresh()
        turn = self.data.xquat[body].tolist()
        x, y, z = self.data.xpos[body].tolist()
        dx, dy, dz = rotated(turn, link_model.position.tolist())
        return (x + dx, y + dy, z + dz), product(turn, link_model.quaternion.tolist())

    def link_pose(self, model: str, link: str) -> Pose:
        """Return the pose of a link in the world frame."""
        found = self.find_model(model)
        return self._link_pose(found, self.find_link(found, link))

    def velocity(self, model: str) -> Velocity:
        """Return the linear [m/s] and angular [rad/s] velocity of a model's frame, along the world's axes."""
        self.find_model(model)
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
        return visual_shapes(self._description)

    def joint_address(self, model: Model, joint: str) -> JointAddress:
        """Return the address of a joint (scoped name) of a moving model."""
        name = scoped(model, joint)
        found = self.model.joint(name)
        control = mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_ACTUATOR, name)
        return JointAddress(int(found.qposadr[0]), int(found.dofadr[0]), control)

    def _nested_pose(self, model: Model, name: str) -> Pose:
        nested = next((each for each in model.nested if each.name == name), None)
        if nested is None:
            hint = did_you_mean(name, [each.name for each in model.nested], listing="its models are")
            raise SimError(f"model '{model.name}' has no model '{name}'{hint}")
        canonical = model.link(nested.canonical_link)
        if canonical is None:
            return self.pose(model.name) * nested.pose
        return self._link_pose(model, canonical) * canonical.pose.inverse() * nested.pose

    def find_model(self, name: str) -> Model:
        """Return a model of the world. Raises SimError if there is none."""
        found = self.models.get(name)
        if found is None:
            hint = did_you_mean(name, self.models, listing="its models are")
            raise SimError(f"world '{self._description.name}' has no model '{name}'{hint}")
        return found

    @staticmethod
    def find_link(model: Model, name: str) -> Link:
        """Return a link of a model by its scoped name. Raises SimError if there is none."""
        found = model.link(name)
        if found is None:
            hint = did_you_mean(name, [each.name for each in model.links], listing="its links are")
            raise SimError(f"model '{model.name}' has no link '{name}'{hint}")
        return found

    def _link_pose(self, model: Model, link: Link) -> Pose:
        body = mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_BODY, scoped(model, link.name))
        if body < 0:  # static, or welded to the world
            return model.pose * link.pose
        self.refresh()
        return Pose(self.data.xpos[body], self.data.xquat[body])
