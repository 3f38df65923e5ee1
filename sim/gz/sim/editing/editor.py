"""Edits a running world: creates, removes and moves entities, and changes lights, visuals, collisions and physics.

`World.editor` is used by UserCommands and by programs. A change is made in the description; then MuJoCo's model is
rebuilt from it, and the state of all unchanged entities is copied exactly (`gz.sim.physics.state`). The original values
are kept for `World.reset`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import fields
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.errors import SimError
from gz_course.sim.gz.sim.physics.builder import scoped
from gz_course.sim.gz.sim.pose import Pose, multiply, rotate
from gz_course.sim.gz.sim.sdf.description import Collision, Light, Model, Visual
from gz_course.sim.gz.sim.sdf.reader import FARTHEST, LONGEST_GOOD_STEP_NS, long_step, read_model
from gz_course.sim.gz.sim.spherical_coordinates import SphericalCoordinates

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.world import World

SHORTEST_STEP_NS, LONGEST_STEP_NS = 1_000, 100_000_000
SPAWNED_FILE = "<spawned>"


class Editor:
    """The methods that change one world; called only by its stepping thread, between two steps."""

    def __init__(self, world: World) -> None:
        """Record the present models, lights and joints, which a reset restores."""
        self._world = world
        self._description = world.description
        self._truth = world.truth
        self._original_models = list(world.description.models)
        self._original_lights = list(world.description.lights)
        self._original_joints = list(world.description.joints)
        self._changed: dict[tuple[int, str], tuple[Any, str, Any]] = {}

    def _change(self, owner: Any, attribute: str, value: Any) -> None:
        """Set an attribute of a description; keep its original value for the reset."""
        self._changed.setdefault((id(owner), attribute), (owner, attribute, getattr(owner, attribute)))
        setattr(owner, attribute, value)

    def restore(self) -> bool:
        """Restore the original description; return whether it had been changed."""
        description = self._description
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
        """Add a model or a light to the running world; return its name.

        `what` is an SDF text, or a description that belongs to no world. `pose` (world frame) replaces the pose of the
        description. With `allow_renaming` a name that is taken gets the suffix `_0`, `_1`, ... The state of all other
        entities is kept exactly; afterwards their motion may differ in the last digits (1e-20 m), because one solver
        computes all bodies together. Raises `SimError` (`SdfError` with file and line for an invalid text) and then
        leaves the world unchanged.
        """
        world = self._world
        world.requests.refuse_inside_step("create an entity")
        made = read_model(what, file_name, world.diagnostics, name, world.resources) if isinstance(what, str) else what
        _check_pose(pose, made.name)
        wanted = name or made.name
        free = self._free_name(wanted, allow_renaming)
        if made.name != free:
            _rename(made, free)
        if pose is not None:
            made.pose = pose
        if isinstance(made, Light):
            self._description.lights.append(made)
            self._rebuild_or_undo(lambda: self._description.lights.remove(made))
            self._world.entities.add_light(made)
        else:
            self._spawn_model(made)
        return free

    def _spawn_model(self, model: Model) -> None:
        self._description.models.append(model)
        self._truth.models[model.name] = model
        self._world.entities.add_model(model)
        try:
            started = self._world.systems.add(model)
            self._world.rebuild()
            self._world.systems.start(started)
            self._world.systems.connect_new()
        except Exception:
            self._forget(model)
            self._world.rebuild()
            raise
        self._world.systems.check_sensors(model)

    def _rebuild_or_undo(self, undo: Callable[[], object]) -> None:
        try:
            self._world.rebuild()
        except Exception:
            undo()
            raise

    def _free_name(self, name: str, allow_renaming: bool) -> str:
        taken = {*self._truth.models, *(light.name for light in self._description.lights)}
        if name not in taken:
            return name
        if not allow_renaming:
            raise SimError(
                f"world '{self._description.name}' already has something called '{name}'; "
                "choose another name or allow renaming"
            )
        number = 0
        while f"{name}_{number}" in taken:
            number += 1
        return f"{name}_{number}"

    def remove(self, name: str) -> None:
        """Remove a model or a light from the running world, with its systems and their topics.

        The state of all other entities is kept exactly. Raises `SimError` with the nearest name for an unknown name.
        """
        self._world.requests.refuse_inside_step("remove an entity")
        light = next((each for each in self._description.lights if each.name == name), None)
        if name in self._truth.models:
            self._forget(self._truth.models[name])
        elif light is not None:
            self._description.lights.remove(light)
            self._world.entities.remove("light", name)
        else:
            known = [*self._truth.models, *(each.name for each in self._description.lights)]
            hint = did_you_mean(name, known, listing="what can be removed is")
            raise SimError(f"world '{self._description.name}' has no model or light '{name}'{hint}")
        self._world.rebuild()

    def _forget(self, model: Model) -> None:
        self._world.systems.remove(model)
        self._description.models.remove(model)
        scope = f"{model.name}::"
        self._description.joints[:] = [
            joint
            for joint in self._description.joints
            if not (joint.child.startswith(scope) or joint.parent.startswith(scope))
        ]
        self._truth.models.pop(model.name, None)
        self._world.entities.remove("model", model.name)

    def set_pose(self, name: str, pose: Pose) -> None:
        """Move a model, a light or a floating link (`model::link`) to a pose in the world frame; its velocity turns
        with it.

        Raises `SimError` for an unknown name and for an entity that is held by a joint.
        """
        self._world.requests.refuse_inside_step("move an entity")
        _check_pose(pose, name)
        light = next((each for each in self._description.lights if each.name == name), None)
        if light is not None and name not in self._truth.models:
            self._change(light, "pose", pose)
            self._world.rebuild()
            return
        owner, _, link = name.partition("::")
        if link and owner in self._truth.models:
            self._set_link_pose(self._truth.models[owner], link, pose)
            return
        model = self._truth.find_model(name)
        move = pose * self._truth.pose(name).inverse()
        held = moved = False
        for part in model.links:
            body = mujoco.mj_name2id(self._world.model, mujoco.mjtObj.mjOBJ_BODY, scoped(model, part.name))
            on_world = body < 0 or int(self._world.model.body_parentid[body]) == 0
            floats = body >= 0 and on_world and self._move_body(body, move)
            moved, held = moved or floats, held or (on_world and not floats)
        if not (moved or held):
            raise SimError(f"model '{name}' hangs on a joint of the world to another model; move that one")
        if held:
            # The pose of a part that is fixed to the world is in the description, not in MuJoCo's state.
            self._change(model, "pose", move * model.pose)
            self._world.rebuild()
        else:
            self._world.part_overlaps()
        self._truth.stale = True

    def _set_link_pose(self, model: Model, link: str, pose: Pose) -> None:
        now = self._truth.link_pose(model.name, link)
        body = mujoco.mj_name2id(self._world.model, mujoco.mjtObj.mjOBJ_BODY, scoped(model, link))
        if body < 0 or not self._move_body(body, pose * now.inverse()):
            raise SimError(
                f"link '{link}' of model '{model.name}' hangs on a joint or on the world, so it cannot be set "
                "down elsewhere; move the whole model"
            )
        self._world.part_overlaps()
        self._truth.stale = True

    def _move_body(self, body: int, move: Pose) -> bool:
        """Move a body that has a free joint, with its velocity; return False if it has none."""
        model, data = self._world.model, self._world.data
        joint = int(model.body_jntadr[body])
        if joint < 0 or int(model.jnt_type[joint]) != int(mujoco.mjtJoint.mjJNT_FREE):
            return False
        q, v = int(model.jnt_qposadr[joint]), int(model.jnt_dofadr[joint])
        there = Pose(move.position + rotate(move.quaternion, data.qpos[q : q + 3]), (1.0, 0.0, 0.0, 0.0))
        turned = multiply(move.quaternion, data.qpos[q + 3 : q + 7])
        data.qpos[q : q + 3] = there.position
        data.qpos[q + 3 : q + 7] = turned / np.linalg.norm(turned)
        # MuJoCo keeps the linear velocity along the world's axes, the angular velocity along the body's own.
        data.qvel[v : v + 3] = rotate(move.quaternion, data.qvel[v : v + 3].copy())
        return True

    def set_light(self, name: str, **changes: Any) -> None:
        """Change attributes of a light of the world; their names are those of `gz.sim.sdf.description.Light`."""
        self._world.requests.refuse_inside_step("change a light")
        light = next((each for each in self._description.lights if each.name == name), None)
        if light is None:
            known = [each.name for each in self._description.lights]
            hint = did_you_mean(name, known, listing="its lights are")
            raise SimError(f"world '{self._description.name}' has no light '{name}'{hint}")
        known_fields = {field.name for field in fields(Light)}
        for attribute, value in changes.items():
            if attribute not in known_fields:
                hint = did_you_mean(attribute, known_fields, listing="known names are")
                raise SimError(f"a light has no {attribute}{hint}")
            self._change(light, attribute, value)
        self._world.rebuild()

    def set_physics(self, *, step_size: float | None = None, real_time_factor: float | None = None) -> None:
        """Change the step size [s] and the real-time factor.

        Raises `SimError` for a step size outside of 1e-6 to 0.1 [s] and for a negative factor.
        """
        self._world.requests.refuse_inside_step("change its physics")
        if step_size is not None:
            step_ns = round(step_size * 1e9) if abs(step_size) < 1.0 else 0
            if not SHORTEST_STEP_NS <= step_ns <= LONGEST_STEP_NS:
                raise SimError(f"max_step_size must be between 0.000001 and 0.1 seconds, got {step_size}")
            if step_ns > LONGEST_GOOD_STEP_NS:
                self._world.diagnostics.warn("", long_step(step_size))
            now = self._world.sim_time_ns
            self._change(self._description, "step_size_ns", step_ns)
            self._world.continue_from(now)
            self._world.rebuild()
        if real_time_factor is not None:
            if not (math.isfinite(real_time_factor) and real_time_factor >= 0.0):
                raise SimError(f"real_time_factor must be zero or more, got {real_time_factor}")
            self._change(self._description, "real_time_factor", real_time_factor)

    def set_spherical_coordinates(self, coordinates: SphericalCoordinates) -> None:
        """Set the place of the world on a planet."""
        self._world.requests.refuse_inside_step("change its spherical coordinates")
        self._change(self._description, "spherical_coordinates", coordinates)
        self._world.rebuild()

    def set_colour(self, visual: Visual, rgba: tuple[float, float, float, float]) -> None:
        """Set the colour of a visual; values of `rgba` are 0..1."""
        self._world.requests.refuse_inside_step("change a visual")
        self._change(visual, "rgba", rgba)
        self._world.rebuild()

    def enable_collisions(self, collisions: list[Collision], enabled: bool) -> None:
        """Enable collisions, or disable them, so that they touch nothing."""
        self._world.requests.refuse_inside_step("change a collision")
        for collision in collisions:
            if not enabled:
                self._change(collision, "bitmask", 0)
            elif (id(collision), "bitmask") in self._changed:
                collision.bitmask = self._changed[(id(collision), "bitmask")][2]
        self._world.rebuild()


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
