"""Compiles a spec to a MuJoCo model and reports MuJoCo's errors in terms of the SDF file.

MuJoCo names its own element (`Element name 'robot::wheel'`), from which the link, joint, collision or visual and its
line in the file are found.
"""

from __future__ import annotations

import re
import warnings

import mujoco

from gz_course.sim.gz.sim.errors import LOG, Diagnostics, SdfError
from gz_course.sim.gz.sim.sdf.description import Collision, Light, Model, Sensor, Visual, WorldDescription
from gz_course.sim.gz.sim.sdf.element import Element

_NAMED = re.compile(r"Element name '([^']*)'")
EMPTY_PREFIX = "Attaching a spec with an empty prefix"
_TAIL = re.compile(r"\s*Element (name|id).*", re.DOTALL)


def hear_warnings() -> None:
    """Let MuJoCo's warnings go to the log, but the one about names of parts, which are complete (`static_parts`)."""
    mujoco.set_mju_user_warning(_warned)


def _warned(text: str) -> None:
    if EMPTY_PREFIX not in text:
        LOG.warning("physics: %s", text)


def compile_world(
    spec: mujoco.MjSpec, world: WorldDescription, diagnostics: Diagnostics
) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """Return the model and its data at time zero. Raises SdfError naming the part that MuJoCo rejects."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        try:
            model = spec.compile()
            data = mujoco.MjData(model)
        except (ValueError, mujoco.FatalError) as error:
            raise _refusal(world, error) from None
    for warning in said:
        text = " ".join(str(warning.message).split()).partition(" Time =")[0]
        if not text.startswith(EMPTY_PREFIX):
            diagnostics.warn(world.element.where, f"the physics engine warns: {text}")
    return model, data


def _refusal(world: WorldDescription, error: Exception) -> SdfError:
    """Return the error that names the part of the world MuJoCo rejects, and the reason."""
    text = str(error)
    named = _NAMED.search(text)
    reason = " ".join(_TAIL.sub("", text).removeprefix("Error: ").split()) or type(error).__name__
    found = _find(world, named.group(1)) if named else None
    if found is None:
        return world.element.error(f"the physics engine refuses this world: {reason}")
    what, element = found
    return element.error(f"the physics engine refuses {what}: {reason}")


def _find(world: WorldDescription, name: str) -> tuple[str, Element] | None:
    name = name.split("#")[0]
    for model in world.models:
        if name.startswith(f"{model.name}::"):
            return _part(model, name[len(model.name) + 2 :])
    return next(((f"joint '{j.name}'", j.element) for j in world.joints if j.name == name), None)


def _part(model: Model, name: str) -> tuple[str, Element]:
    for link in model.links:
        if link.name == name:
            return f"link '{name}' of model '{model.name}'", link.element
        parts: list[Collision | Visual | Sensor | Light] = [
            *link.collisions,
            *link.visuals,
            *link.sensors,
            *link.lights,
        ]
        for part in parts:
            if f"{link.name}::{part.name}" == name:
                return f"<{part.element.tag}> '{part.name}' of link '{link.name}'", part.element
    for joint in model.joints:
        if joint.name == name:
            return f"joint '{name}' of model '{model.name}'", joint.element
    return f"model '{model.name}'", model.element
