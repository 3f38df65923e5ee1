"""An SDF text becomes a `WorldDescription`: includes opened, frames resolved, nested models flattened.

`World.load` -> `read_world_file` -> (here) -> `gz.sim.physics.builder`. What SDF does not know is reported
and skipped; what makes no sense (a number that is no number, a joint to a link that does not exist) raises
`SdfError` at its line.
"""

from __future__ import annotations

import math
from pathlib import Path

from gz.sim.errors import Diagnostics, ResourceError, SdfError
from gz.sim.pose import Pose
from gz.sim.sdf import vocabulary
from gz.sim.sdf.description import Light, Model, NestedModel, Plugin, WorldDescription
from gz.sim.sdf.element import Element, parse
from gz.sim.sdf.frames import Scope
from gz.sim.sdf.joints import read_joint
from gz.sim.sdf.links import read_link
from gz.sim.sdf.resources import find_model, read_text
from gz.sim.spherical_coordinates import SphericalCoordinates

_MAX_INCLUDE_DEPTH = 20


def read_world_file(path: Path, diagnostics: Diagnostics) -> WorldDescription:
    """Read the world of an SDF file; a file with only models is put into a world of its own, as `gz sim`
    refuses to.
    """
    return read_world(read_text(path), str(path), diagnostics)


def read_world(text: str, file: str, diagnostics: Diagnostics) -> WorldDescription:
    """Read the world of an SDF text; `file` names it in messages and is where relative includes start."""
    root = _read_root(text, file, diagnostics)
    world = root.find("world")
    if world is None:
        raise root.error("the file has no <world>; a world file reads <sdf version='1.10'><world name='...'>")
    if not world.name:
        raise world.error("<world> needs a name attribute")
    return _WorldReader(_version(root), diagnostics).read(world)


def read_model(text: str, file: str, diagnostics: Diagnostics, name: str = "") -> Model | Light:
    """Read the one model (or light) of an SDF text that comes into a running world; `name` replaces its own.

    It is read as if it stood in a world of its own, so its pose is in the world frame.
    """
    root = _read_root(text, file, diagnostics)
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
    world = _WorldReader(_version(root), diagnostics).read(around)
    if not world.models and not world.lights:
        raise entity.error("what this <include> names was not found, so nothing is created")
    return (*world.models, *world.lights)[0]


def _read_root(text: str, file: str, diagnostics: Diagnostics) -> Element:
    root = parse(text, file)
    if root.tag != "sdf":
        raise root.error(f"the outermost element must be <sdf>, got <{root.tag}>")
    _version(root)
    vocabulary.check(root, diagnostics)
    return root


def _version(root: Element) -> tuple[int, int]:
    text = root.attributes.get("version", "1.10")
    major, _, minor = text.partition(".")
    if not (major.isdigit() and minor.isdigit()):
        raise root.error(f"sdf version must look like 1.10, got '{text}'")
    return int(major), int(minor)


def _pose_and_base(element: Element) -> tuple[Pose, str]:
    """Return an element's own `<pose>` and the frame it is given in (empty: the default one)."""
    pose = element.find("pose")
    if pose is None:
        return Pose(), ""
    return pose.pose(), pose.attributes.get("relative_to", "") or pose.attributes.get("frame", "")


class _WorldReader:
    """Walks one `<world>`; holds what every level needs: the SDF version and where warnings go."""

    def __init__(self, version: tuple[int, int], diagnostics: Diagnostics) -> None:
        self._version = version
        self._diagnostics = diagnostics

    def read(self, world: Element) -> WorldDescription:
        description = WorldDescription(world.name, world, version=self._version)
        x, y, z = world.vector("gravity", (0.0, 0.0, -9.8))
        description.gravity = (x, y, z)
        if not all(map(math.isfinite, description.gravity)):
            raise world.error("<gravity> must be finite")
        coordinates = world.find("spherical_coordinates")
        description.spherical_coordinates = SphericalCoordinates.from_sdf(coordinates, self._diagnostics)
        x, y, z = world.vector("magnetic_field", description.magnetic_field)
        description.magnetic_field = (x, y, z)
        if not all(map(math.isfinite, description.magnetic_field)):
            raise world.error("<magnetic_field> must be finite")
        self._read_physics(world, description)
        scene = world.find("scene")
        if scene is not None:
            description.ambient = _rgb(scene, "ambient", description.ambient)
            description.background = _rgb(scene, "background", description.background)
        scope = Scope("world", world)
        models: list[tuple[Element, Model]] = []
        for child in world.children:
            opened = self._open(child, 0, self._version)
            if opened is None:
                continue
            element, version = opened
            if element.tag == "model":
                model, nested, pose, base = self._model(element, version, False, 0)
                scope.add(element.name, child, pose=pose, relative_to=base, nested=nested)
                models.append((element, model))
            elif element.tag == "frame":
                pose, base = _pose_and_base(element)
                attached = element.attributes.get("attached_to", "")
                scope.add(element.name, element, pose=pose, relative_to=base or attached, attached_to=attached)
            elif element.tag == "light":
                description.lights.append(_light(element))
            elif element.tag == "plugin":
                description.plugins.append(_plugin(element, ""))
            elif element.tag in ("joint", "actor", "road", "population", "state"):
                self._diagnostics.warn(
                    element.where, f"<{element.tag}> in a <world> is not simulated here, it is skipped"
                )
        for element, model in models:
            model.pose = scope.pose_of(element.name, element)
            if not model.static and not model.links:
                raise element.error(f"model '{model.name}' has no link; give it at least one <link>")
            description.models.append(model)
        return description

    def _read_physics(self, world: Element, description: WorldDescription) -> None:
        physics = world.find("physics")
        if physics is None:
            return
        step = physics.number("max_step_size", 0.001)
        step_ns = round(step * 1e9) if math.isfinite(step) else 0
        if not 1_000 <= step_ns <= 100_000_000:
            raise physics.error(f"<max_step_size> must be between 0.000001 and 0.1 seconds, got {step}")
        description.step_size_ns = step_ns
        description.real_time_factor = max(0.0, physics.number("real_time_factor", 1.0))

    def _open(self, include: Element, depth: int, version: tuple[int, int]) -> tuple[Element, tuple[int, int]] | None:
        """Return what an `<include>` brings, its overrides put in, and the SDF version of its file.

        Any other element is returned as it is, with the `version` of the file it stands in.
        """
        if include.tag != "include":
            return include, version
        uri = include.text_of("uri")
        if not uri:
            raise include.error("<include> needs a <uri>, for example <uri>model://ground_plane</uri>")
        if depth > _MAX_INCLUDE_DEPTH:
            raise include.error(f"'{uri}' is included inside itself; more than {_MAX_INCLUDE_DEPTH} levels were opened")
        base = Path(include.file).parent if include.file != "<string>" else None
        try:
            path = find_model(uri, base)
        except ResourceError as error:
            self._diagnostics.warn(include.where, f"the include is skipped: {error}")
            return None
        root = _read_root(read_text(path), str(path), self._diagnostics)
        found = root.find("model") or root.find("light")
        if found is None:
            raise SdfError(f"{include.where}: '{uri}' leads to {path}, which holds no <model>")
        if include.attributes.get("merge", "false") in ("true", "1"):
            self._diagnostics.warn(
                include.where, "merge='true' is not done here; the model is nested under its own name"
            )
        for tag in ("static", "pose"):
            override = include.find(tag)
            if override is not None:
                found.children = [child for child in found.children if child.tag != tag]
                found.children.append(override)
        name = include.text_of("name")
        if name:
            found.attributes["name"] = name
        placement = include.text_of("placement_frame")
        if placement:
            found.attributes["placement_frame"] = placement
        found.children.extend(include.all("plugin"))
        return found, _version(root)

    def _model(
        self, element: Element, version: tuple[int, int], static: bool, depth: int
    ) -> tuple[Model, Scope, Pose, str]:
        """Read a model; return it flattened, its scope, its stated pose and the frame of that pose."""
        if not element.name:
            raise element.error("<model> needs a name attribute")
        static = static or element.flag("static", False)
        model = Model(element.name, Pose(), element, static, element.flag("self_collide", False))
        model.version = version
        scope = Scope("__model__", element)
        nested: list[tuple[str, Model]] = []
        for child in element.children:
            brought = self._open(child, depth + 1, version)
            if brought is None:
                continue
            opened, own_version = brought
            if opened.tag == "model":
                inner, inner_scope, pose, base = self._model(opened, own_version, static, depth + 1)
                scope.add(opened.name, child, pose=pose, relative_to=base, nested=inner_scope)
                nested.append((opened.name, inner))
            elif opened.tag in ("link", "frame", "joint"):
                self._add_frame(scope, opened)
            elif opened.tag == "plugin":
                model.plugins.append(_plugin(opened, ""))
        for link in element.all("link"):
            model.links.append(read_link(link, scope, model, self._diagnostics))
        for name, inner in nested:
            _flatten(model, inner, name, scope.pose_of(name, inner.element))
        if model.links:
            model.canonical_link = scope.canonical_link(element)
        for joint in element.all("joint"):
            model.joints.append(read_joint(joint, scope, model, version, self._diagnostics))
        pose, base = _pose_and_base(element)
        placement = element.attributes.get("placement_frame", "")
        if placement:
            pose = pose * scope.pose_of(placement, element).inverse()
        return model, scope, pose, base

    def _add_frame(self, scope: Scope, element: Element) -> None:
        pose, base = _pose_and_base(element)
        if element.tag == "link":
            scope.add(element.name, element, pose=pose, relative_to=base, is_link=True)
        elif element.tag == "frame":
            attached = element.attributes.get("attached_to", "")
            scope.add(element.name, element, pose=pose, relative_to=base or attached, attached_to=attached)
        else:
            child = element.text_of("child")
            scope.add(element.name, element, pose=pose, relative_to=base or child, attached_to=child)


def _flatten(model: Model, inner: Model, name: str, pose: Pose) -> None:
    """Put a nested model's parts into its parent, with `name::` before every name."""
    for link in inner.links:
        link.name = f"{name}::{link.name}"
        link.pose = pose * link.pose
        link.self_collide = link.self_collide or inner.self_collide
        for sensor in link.sensors:
            sensor.link = link.name
            sensor.model = model.name
        model.links.append(link)
    model.nested.append(NestedModel(name, pose, inner.element, f"{name}::{inner.canonical_link}"))
    for nested in inner.nested:
        canonical = f"{name}::{nested.canonical_link}"
        model.nested.append(NestedModel(f"{name}::{nested.name}", pose * nested.pose, nested.element, canonical))
    for joint in inner.joints:
        joint.name = f"{name}::{joint.name}"
        joint.child = f"{name}::{joint.child}"
        joint.parent = joint.parent if joint.parent == "world" else f"{name}::{joint.parent}"
        for sensor in joint.sensors:
            sensor.joint, sensor.link, sensor.model = joint.name, joint.child, model.name
        model.joints.append(joint)
    for plugin in inner.plugins:
        plugin.scope = f"{name}::{plugin.scope}" if plugin.scope else name
        model.plugins.append(plugin)


def _plugin(element: Element, scope: str) -> Plugin:
    name, filename = element.name, element.attributes.get("filename", "")
    if not name and not filename:
        raise element.error("<plugin> needs filename and name, for example name='gz::sim::systems::DiffDrive'")
    return Plugin(name, filename, element, scope)


def _light(element: Element) -> Light:
    kind = element.attributes.get("type", "point")
    x, y, z = element.vector("direction", (0.0, 0.0, -1.0))
    return Light(element.name, kind, _pose_and_base(element)[0], (x, y, z), _rgb(element, "diffuse", (1.0, 1.0, 1.0)))


def _rgb(element: Element, tag: str, default: tuple[float, float, float]) -> tuple[float, float, float]:
    child = element.find(tag)
    if child is None or not child.text:
        return default
    values = child.floats(len(child.text.split()) if len(child.text.split()) in (3, 4) else 4)
    return values[0], values[1], values[2]
