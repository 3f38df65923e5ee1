"""Reader of SDF: converts a text to a `WorldDescription`.

Includes are opened, frames are resolved and nested models are flattened. `World.load` calls `read_world_file`;
`gz.sim.physics.builder` builds the result. Unknown elements are ignored with a warning; invalid ones (a text instead of
a number, a joint to a link that does not exist) raise `SdfError` with the line.

Source: SDFormat, elements `<sdf>` and `<world>`, http://sdformat.org/spec
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from gz_course.sim.gz.sim.errors import Diagnostics, SdfError
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.sdf import plausibility
from gz_course.sim.gz.sim.sdf.description import Light, Model, WorldDescription
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.sdf.frames import Scope
from gz_course.sim.gz.sim.sdf.includes import Includes, Opened, read_root, sdf_version
from gz_course.sim.gz.sim.sdf.joints import read_world_joint
from gz_course.sim.gz.sim.sdf.lights import read_light, read_rgb
from gz_course.sim.gz.sim.sdf.models import ModelReader, add_frame, joint_to_skipped, pose_and_base, read_plugin
from gz_course.sim.gz.sim.sdf.resources import FILES, Resources, read_text
from gz_course.sim.gz.sim.spherical_coordinates import SphericalCoordinates

FARTHEST = 1e7  # [m]
LONGEST_GOOD_STEP_NS = 20_000_000
_NOT_SIMULATED = {
    "actor": "is not simulated here, it is left out",
    "road": "is not simulated here, it is left out; use a flat box",
    "population": "is not simulated here; place the models one by one",
    "state": "is a saved state, which is not restored; the models start where they are defined",
    "audio": "is not simulated here, the world is silent",
}


def read_world_file(path: Path, diagnostics: Diagnostics) -> WorldDescription:
    """Read the world of an SDF file. Raises `SdfError` for any other file, including one with only a model."""
    return read_world(read_text(path), str(path), diagnostics)


def read_world(text: str, file: str, diagnostics: Diagnostics, resources: Resources = FILES) -> WorldDescription:
    """Read the world of an SDF text.

    `file` is its name in messages and the base of relative includes; `resources` opens the files it refers to.
    """
    root = read_root(text, file, diagnostics)
    world = root.find("world")
    if world is None and root.find("model") is not None:
        raise root.error(
            "the file holds a model, not a world: name it in the <include><uri> of a world, or create it in a running "
            "one (service /world/WORLD/create)"
        )
    if world is None:
        raise root.error("the file has no <world>; a world file reads <sdf version='1.10'><world name='...'>")
    if not world.name:
        raise world.error("<world> needs a name attribute")
    return _WorldReader(sdf_version(root), diagnostics, resources).read(world)


def read_model(
    text: str, file: str, diagnostics: Diagnostics, name: str = "", resources: Resources = FILES
) -> Model | Light:
    """Read the model or light of an SDF text that is created in a running world; `name` replaces its name.

    Its pose is in the world frame.
    """
    root = read_root(text, file, diagnostics)
    found = [child for child in root.children if child.tag in ("model", "light", "include")]
    if not found:
        inside = ", ".join(f"<{child.tag}>" for child in root.children[:3]) or "nothing"
        raise root.error(f"there is no <model> or <light> directly in <sdf>, only {inside}")
    if len(found) > 1:
        diagnostics.warn(found[1].where, f"only the first of {len(found)} models and lights is created")
    entity = found[0]
    if name and entity.tag == "include":
        entity.children = [child for child in entity.children if child.tag != "name"]
        entity.children.append(Element("name", text=name, file=entity.file, line=entity.line))
    elif name:
        entity.attributes["name"] = name
    around = Element("world", {"name": "spawned"}, children=[entity], file=root.file, line=root.line)
    world = _WorldReader(sdf_version(root), diagnostics, resources).read(around)
    if not world.models and not world.lights:
        why = diagnostics.warnings[-1] if diagnostics.warnings else f"{entity.where}: there is no model in it"
        raise SdfError(f"{why}; nothing is created")
    return world.models[0] if world.models else world.lights[0]


class _WorldReader:
    """Reads one `<world>`; holds the SDF version, the includes and the diagnostics."""

    def __init__(self, version: tuple[int, int], diagnostics: Diagnostics, resources: Resources) -> None:
        self._version = version
        self._diagnostics = diagnostics
        self._includes = Includes(diagnostics, resources)
        self._models = ModelReader(self._includes, diagnostics)

    def read(self, world: Element) -> WorldDescription:
        description = WorldDescription(world.name, world, version=self._version)
        x, y, z = world.vector("gravity", (0.0, 0.0, -9.8))
        description.gravity = (x, y, z)
        if not all(abs(value) < 1e6 for value in description.gravity):
            raise (world.find("gravity") or world).error("<gravity> must be finite")
        coordinates = world.find("spherical_coordinates")
        description.spherical_coordinates = SphericalCoordinates.from_sdf(coordinates, self._diagnostics)
        x, y, z = world.vector("magnetic_field", description.magnetic_field)
        description.magnetic_field = (x, y, z)
        if not all(map(math.isfinite, description.magnetic_field)):
            raise world.error("<magnetic_field> must be finite")
        self._read_physics(world, description)
        wind = world.find("wind")
        if wind is not None:
            x, y, z = wind.vector("linear_velocity", description.wind)
            description.wind = (x, y, z)
            if not all(map(math.isfinite, description.wind)):
                raise wind.error("<linear_velocity> of <wind> must be finite")
        scene = world.find("scene")
        if scene is not None:
            description.ambient = read_rgb(scene, "ambient", description.ambient)
            description.background = read_rgb(scene, "background", description.background)
        self._read_entities(world, description)
        return description

    def _read_entities(self, world: Element, description: WorldDescription) -> None:
        """Read models, lights, frames, joints and plugins, including those of included files."""
        scope = Scope("world", world)
        models: list[tuple[Opened, Model]] = []
        lights: list[Element] = []
        joints: list[Opened] = []
        for part in self._parts(world):
            element = part.element
            if element.tag == "model":
                model, nested, pose, base = self._models.read(part)
                scope.add(element.name, part.place, pose=pose, relative_to=base, nested=nested)
                models.append((part, model))
            elif element.tag in ("frame", "joint"):
                add_frame(scope, element)
                if element.tag == "joint":
                    joints.append(part)
            elif element.tag == "light":
                lights.append(element)
            elif element.tag == "plugin":
                description.plugins.append(read_plugin(element))
            elif element.tag in _NOT_SIMULATED:
                self._diagnostics.warn(element.where, f"<{element.tag}> {_NOT_SIMULATED[element.tag]}")
        for part, model in models:
            model.pose = scope.pose_of(part.element.name, part.place)
            if _too_far(model.pose):
                self._diagnostics.warn(part.place.where, f"{_far(part.place)}, so it is left out")
                self._includes.empty.add(model.name)
                continue
            if not model.static and not model.links:
                if _has_include(part.element):
                    text = f"model '{model.name}' holds nothing but what was not found, so it is left out too"
                    self._diagnostics.warn(part.place.where, text)
                    self._includes.empty.add(model.name)
                    continue
                raise part.element.error(f"model '{model.name}' has no link; give it at least one <link>")
            description.models.append(model)
        for element in lights:
            pose, base = pose_and_base(element)
            pose = scope.pose_of(base, element) * pose if base else pose
            if _too_far(pose):
                self._diagnostics.warn(element.where, f"{_far(element)}, so it is left out")
                continue
            description.lights.append(read_light(element, pose, self._diagnostics))
        taken: dict[str, Element] = {}
        for element in lights:
            first = taken.setdefault(element.name, element)
            if first is not element:
                raise element.error(f"<light> is called '{element.name}', but the <light> at {first.where} is already")
        for part in joints:
            if not joint_to_skipped(part.element, scope, self._includes, self._diagnostics):
                description.joints.append(read_world_joint(part.element, scope, description.models, part.version))
        if self._includes.found_all:  # else a base may be what was not found
            scope.check()
        held = {end.partition("::")[0] for joint in description.joints for end in (joint.parent, joint.child)}
        for model in description.models:
            plausibility.check_model(model, model.name in held, self._diagnostics)
        plausibility.check_masses(description.models, self._diagnostics)

    def _parts(self, world: Element) -> list[Opened]:
        chain = () if world.folder is None else (self._includes.resources.real(Path(world.file)),)
        found: list[Opened] = []
        for child in world.children:
            part = self._includes.open(child, self._version, chain)
            if part is not None:
                found.extend(self._models.merged(part, world=True) if part.merged else [part])
        return found

    def _read_physics(self, world: Element, description: WorldDescription) -> None:
        profiles = list(world.all("physics"))
        if not profiles:
            return
        chosen = [each for each in profiles if each.attributes.get("default", "false").lower() in ("true", "1")]
        physics = (chosen or profiles)[0]
        step = physics.number("max_step_size", 0.001)
        if not 1e-6 <= step <= 0.1:
            where = physics.find("max_step_size") or physics
            raise where.error(f"<max_step_size> must be between 0.000001 and 0.1 seconds, got {step:g}")
        description.step_size_ns = round(step * 1e9)
        if description.step_size_ns > LONGEST_GOOD_STEP_NS:
            self._diagnostics.warn((physics.find("max_step_size") or physics).where, long_step(step))
        factor = physics.number("real_time_factor", 1.0)
        description.real_time_factor = max(0.0, factor) if math.isfinite(factor) else 0.0


def _has_include(model: Element) -> bool:
    """Return whether a model or one nested in it includes a file."""
    return any(child.tag == "include" or (child.tag == "model" and _has_include(child)) for child in model.children)


def long_step(step: float) -> str:
    """Return the warning about a step of `step` [s] that is longer than recommended."""
    return (
        f"<max_step_size> is {step:g} s; above {LONGEST_GOOD_STEP_NS * 1e-9:g} s wheels slip (a robot is 7 % slow at "
        "0.05 s, 25 % at 0.1 s), what stands sinks in, and stiff joints become unstable; 0.001 to 0.004 s is usual"
    )


def _too_far(pose: Pose) -> bool:
    """Return whether a pose is so far from the origin that floating-point numbers lose precision."""
    return not np.max(np.abs(pose.position)) < FARTHEST


def _far(element: Element) -> str:
    return f"<{element.tag}> '{element.name}' stands more than {FARTHEST:g} m away from the origin"
