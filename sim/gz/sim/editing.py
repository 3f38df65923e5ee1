"""Changes of a world while it runs: spawn, remove, set_pose and the properties of lights, visuals and collisions.

A part of World, in a file of its own; UserCommands and library users call it between steps. Every change is made
to the description, then MuJoCo's model is built anew from it and the state of all else is carried over bit for bit
(`gz.sim.physics.state`). What was changed is remembered, so that `World.reset` can take it back.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import fields
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from gz_course.sim.gz.sim.errors import Diagnostics, SimError, nearest
from gz_course.sim.gz.sim.physics.builder import scoped
from gz_course.sim.gz.sim.pose import Pose, multiply, rotate
from gz_course.sim.gz.sim.sdf.description import Collision, Light, Model, Visual
from gz_course.sim.gz.sim.sdf.reader import FARTHEST, read_model
from gz_course.sim.gz.sim.spherical_coordinates import SphericalCoordinates
from gz_course.sim.gz.sim.system_manager import SystemManager
from gz_course.sim.gz.sim.truth import Truth

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.entities import Entities
    from gz_course.sim.gz.sim.requests import Requests
    from gz_course.sim.gz.sim.sdf.resources import Resources

DEEP_M = 0.01
"""A model that starts this deep inside others is worth a sentence."""
SPAWNED_FILE = "<spawned>"


class Editing(Truth):
    """The methods of World that change what is in it."""

    diagnostics: Diagnostics
    entities: Entities
    requests: Requests
    resources: Resources
    _manager: SystemManager

    def _rebuild(self) -> None:
        raise NotImplementedError

    def _begin_editing(self) -> None:
        """Remember the world as it is now: this is what a reset brings back."""
        self._original_models = list(self.description.models)
        self._original_lights = list(self.description.lights)
        self._original_joints = list(self.description.joints)
        self._changed: dict[tuple[int, str], tuple[Any, str, Any]] = {}

    def _change(self, owner: Any, attribute: str, value: Any) -> None:
        """Change one attribute of a description; the first value is kept for the reset."""
        self._changed.setdefault((id(owner), attribute), (owner, attribute, getattr(owner, attribute)))
        setattr(owner, attribute, value)

    def _restore(self) -> bool:
        """Make the description what it was at first; True when anything in it had changed."""
        description = self.description
        same = description.models == self._original_models and description.lights == self._original_lights
        changed = bool(self._changed) or not same
        for owner, attribute, value in self._changed.values():
            setattr(owner, attribute, value)
        self._changed.clear()
        description.models[:] = self._original_models
        description.lights[:] = self._original_lights
        description.joints[:] = self._original_joints
        return changed

    def spawn(
        self,
        what: str | Model | Light,
        *,
        name: str = "",
        pose: Pose | None = None,
        allow_renaming: bool = False,
        file_name: str = SPAWNED_FILE,
    ) -> str:
        """Put a model or a light into the running world; return the name it got.

        `what` is an SDF text, or a description that is in no world yet. `pose` (world frame) replaces its own. A name
        that is taken gets `_0`, `_1`, ... behind it with `allow_renaming`. The state of all else stays as it is, to the
        bit. From then on one solver serves all, so that last digits (1e-20 m) may differ. Raises `SimError` (`SdfError`
        with file and line for a bad text); the world is then as before.
        """
        self.requests.refuse_inside_step("take in a model")
        made = read_model(what, file_name, self.diagnostics, name, self.resources) if isinstance(what, str) else what
        _check_pose(pose, made.name)
        wanted = name or made.name
        free = self._free_name(wanted, allow_renaming)
        if made.name != free:
            _rename(made, free)
        if pose is not None:
            made.pose = pose
        if isinstance(made, Light):
            self.description.lights.append(made)
            self._rebuild_or_undo(lambda: self.description.lights.remove(made))
            self.entities.add_light(made)
        else:
            self._spawn_model(made)
        return free

    def _spawn_model(self, model: Model) -> None:
        self.description.models.append(model)
        self._models[model.name] = model
        self.entities.add_model(model)
        try:
            started = self._manager.add(model)
            self._rebuild()
            self._manager.start(started)
            self._manager.connect_new()
        except Exception:
            self._forget(model)
            self._rebuild()
            raise
        self._manager.check_sensors(model)
        self._check_overlap(model)

    def _rebuild_or_undo(self, undo: Callable[[], object]) -> None:
        try:
            self._rebuild()
        except Exception:
            undo()
            raise

    def _free_name(self, name: str, allow_renaming: bool) -> str:
        taken = {*self._models, *(light.name for light in self.description.lights)}
        if name not in taken:
            return name
        if not allow_renaming:
            raise SimError(
                f"world '{self.name}' already has something called '{name}'; choose another name or allow renaming"
            )
        number = 0
        while f"{name}_{number}" in taken:
            number += 1
        return f"{name}_{number}"

    def _check_overlap(self, model: Model) -> None:
        """Say so when a model starts deep inside others: the physics will push it out."""
        prefix = f"{model.name}::"
        for contact in self.data.contact[: self.data.ncon]:
            names = [mujoco.mj_id2name(self.model, mujoco.mjtObj.mjOBJ_GEOM, int(geom)) or "" for geom in contact.geom]
            own = [each for each in names if each.startswith(prefix)]
            if contact.dist < -DEEP_M and len(own) == 1:
                other = next(each for each in names if not each.startswith(prefix)).split("::")[0]
                self.diagnostics.warn(
                    "", f"model '{model.name}' starts {-contact.dist:.3f} m inside '{other}', which pushes it out"
                )
                return

    def remove(self, name: str) -> None:
        """Take a model or a light out of the running world; raise `SimError` with the nearest name for an unknown one.

        Its systems end and their topics go; all else goes on exactly as it was.
        """
        self.requests.refuse_inside_step("let go of a model")
        light = next((each for each in self.description.lights if each.name == name), None)
        if name in self._models:
            self._forget(self._models[name])
        elif light is not None:
            self.description.lights.remove(light)
            self.entities.remove("light", name)
        else:
            known = [*self._models, *(each.name for each in self.description.lights)]
            hint = nearest(name, known, listing="what can be removed is")
            raise SimError(f"world '{self.name}' has no model or light '{name}'; {hint}")
        self._rebuild()

    def _forget(self, model: Model) -> None:
        self._manager.remove(model)
        self.description.models.remove(model)
        scope = f"{model.name}::"
        self.description.joints[:] = [
            joint
            for joint in self.description.joints
            if not (joint.child.startswith(scope) or joint.parent.startswith(scope))
        ]
        self._models.pop(model.name, None)
        self.entities.remove("model", model.name)

    def set_pose(self, name: str, pose: Pose) -> None:
        """Move a model, a light or a floating link (`model::link`) to a pose in the world frame, with its velocity
        turned along; raise `SimError` for what is not there or cannot be moved.
        """
        self.requests.refuse_inside_step("move a model")
        _check_pose(pose, name)
        light = next((each for each in self.description.lights if each.name == name), None)
        if light is not None and name not in self._models:
            self._change(light, "pose", pose)
            self._rebuild()
            return
        owner, _, link = name.partition("::")
        if link and owner in self._models:
            self._set_link_pose(self._models[owner], link, pose)
            return
        model = self._model(name)
        move = pose * self.pose(name).inverse()
        held = moved = False
        for part in model.links:
            body = mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_BODY, scoped(model, part.name))
            on_world = body < 0 or int(self.model.body_parentid[body]) == 0
            floats = body >= 0 and on_world and self._move_body(body, move)
            moved, held = moved or floats, held or (on_world and not floats)
        if not (moved or held):
            raise SimError(f"model '{name}' hangs on a joint of the world to another model; move that one")
        if held:
            # What the world holds stands where the description says, not in the state.
            self._change(model, "pose", move * model.pose)
            self._rebuild()
        self._refreshed = -1

    def _set_link_pose(self, model: Model, link: str, pose: Pose) -> None:
        found = self._link(model, link)
        body = mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_BODY, scoped(model, link))
        now = self._link_pose(model, found)
        if body < 0 or not self._move_body(body, pose * now.inverse()):
            raise SimError(
                f"link '{link}' of model '{model.name}' hangs on a joint or on the world, so it cannot be set "
                "down elsewhere; move the whole model"
            )
        self._refreshed = -1

    def _move_body(self, body: int, move: Pose) -> bool:
        """Move a body that floats freely, with its velocity; False when it does not float."""
        model, data = self.model, self.data
        joint = int(model.body_jntadr[body])
        if joint < 0 or int(model.jnt_type[joint]) != int(mujoco.mjtJoint.mjJNT_FREE):
            return False
        q, v = int(model.jnt_qposadr[joint]), int(model.jnt_dofadr[joint])
        there = Pose(move.position + rotate(move.quaternion, data.qpos[q : q + 3]), (1.0, 0.0, 0.0, 0.0))
        turned = multiply(move.quaternion, data.qpos[q + 3 : q + 7])
        data.qpos[q : q + 3] = there.position
        data.qpos[q + 3 : q + 7] = turned / np.linalg.norm(turned)
        # MuJoCo keeps the linear velocity in world axes and the angular one in the body's own.
        data.qvel[v : v + 3] = rotate(move.quaternion, data.qvel[v : v + 3].copy())
        return True

    def set_light(self, name: str, **changes: Any) -> None:
        """Change attributes of a light of the world (those of `gz.sim.sdf.description.Light`)."""
        self.requests.refuse_inside_step("change a light")
        light = next((each for each in self.description.lights if each.name == name), None)
        if light is None:
            known = [each.name for each in self.description.lights]
            raise SimError(
                f"world '{self.name}' has no light '{name}'; {nearest(name, known, listing='its lights are')}"
            )
        known_fields = {field.name for field in fields(Light)}
        for attribute, value in changes.items():
            if attribute not in known_fields:
                raise SimError(f"a light has no {attribute}; {nearest(attribute, known_fields)}")
            self._change(light, attribute, value)
        self._rebuild()

    def set_spherical_coordinates(self, coordinates: SphericalCoordinates) -> None:
        """Say where on a planet the world lies."""
        self.requests.refuse_inside_step("move to another place")
        self._change(self.description, "spherical_coordinates", coordinates)
        self._rebuild()

    def set_colour(self, visual: Visual, rgba: tuple[float, float, float, float]) -> None:
        """Paint a visual; `rgba` each 0..1."""
        self.requests.refuse_inside_step("change a visual")
        self._change(visual, "rgba", rgba)
        self._rebuild()

    def enable_collisions(self, collisions: list[Collision], enabled: bool) -> None:
        """Let collisions touch again, or touch nothing from now on."""
        self.requests.refuse_inside_step("change a collision")
        for collision in collisions:
            if not enabled:
                self._change(collision, "bitmask", 0)
            elif (id(collision), "bitmask") in self._changed:
                collision.bitmask = self._changed[(id(collision), "bitmask")][2]
        self._rebuild()


def _check_pose(pose: Pose | None, name: str) -> None:
    if pose is None:
        return
    if not (np.all(np.isfinite(pose.position)) and np.all(np.isfinite(pose.quaternion))):
        raise SimError(f"the pose for '{name}' is not finite, so it is refused; check for division by zero")
    if not np.max(np.abs(pose.position)) < FARTHEST:
        raise SimError(f"the pose for '{name}' is more than {FARTHEST:g} m away from the origin, so it is refused")
    if not math.isclose(float(np.linalg.norm(pose.quaternion)), 1.0, abs_tol=1e-3):
        raise SimError(f"the orientation for '{name}' is no unit quaternion, so it is refused")


def _rename(made: Model | Light, name: str) -> None:
    if isinstance(made, Model):
        for sensor in made.sensors():
            sensor.model = name
    made.name = name
    made.element.attributes["name"] = name
