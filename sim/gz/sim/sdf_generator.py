"""Writes a running world as SDF text with the present poses of its models and lights.

Used by the service `/world/W/generate_world_sdf`, recordings and `gz model`. As in Gazebo the models are written as
they were read; joints are at zero when the text is loaded. An `<include>` is kept, unless it is to be expanded.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/SdfGenerator.cc
"""

from __future__ import annotations

import copy
from pathlib import Path
from typing import TYPE_CHECKING

from gz_course.sim.gz.sim.errors import LOG, ResourceError
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.sdf.description import Light, Model
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.sdf.resources import find_model
from gz_course.sim.gz.sim.sdf.writer import pose_element, to_xml

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess

_FRAMES_CHANGED = (1, 7)
_ROOTS = ("model", "light", "include")


def generate_world(world: WorldAccess, *, expand_includes: bool = False) -> str:
    """Return the SDF text of a world as it is now.

    `expand_includes` writes the content of included models if it has the same SDF version as the world; relative
    `<uri>`s become absolute paths.
    """
    return _Generator(world, expand_includes).text()


class _Generator:
    def __init__(self, world: WorldAccess, expand: bool) -> None:
        self._world = world
        self._expand = expand
        self._version = world.description.version

    def text(self) -> str:
        description = self._world.description
        source = description.element
        written = Element("world", dict(source.attributes) | {"name": description.name})
        models, lights = list(description.models), list(description.lights)
        for child in source.children:
            if child.tag == "joint" and not any(joint.element is child for joint in description.joints):
                continue  # one of its models was removed
            if child.tag not in _ROOTS:
                written.children.append(self._physics(child) if child.tag == "physics" else absolute_copy(child))
                continue
            model = next((each for each in models if _came_from(each.element, each.name, child)), None)
            light = next((each for each in lights if _came_from(each.element, each.name, child)), None)
            if model is not None:
                models.remove(model)
                written.children.append(self._model(model, child))
            elif light is not None:
                lights.remove(light)
                written.children.append(self._light(light, child))
        written.children += (self._model(model, model.element) for model in models)
        written.children += (self._light(light, light.element) for light in lights)
        major, minor = self._version
        root = Element("sdf", {"version": f"{major}.{minor}"}, children=[written])
        return f'<?xml version="1.0" ?>\n{to_xml(root)}\n'

    def _physics(self, element: Element) -> Element:
        """Write the present step size and real-time factor."""
        made = absolute_copy(element)
        description = self._world.description
        for tag, value in (
            ("max_step_size", repr(description.step_size_ns * 1e-9)),
            ("real_time_factor", repr(description.real_time_factor)),
        ):
            child = made.find(tag)
            if child is not None:
                child.text = value
        return made

    def _model(self, model: Model, source: Element) -> Element:
        pose = self._world.truth.pose(model.name)
        if source.tag == "include" and (not self._expand or model.version != self._version):
            made = _placed(absolute_copy(source), pose, self._version)
            made.children = [child for child in made.children if child.tag not in ("name", "placement_frame")]
            made.children.insert(0, Element("name", text=model.name))
            return made
        if model.version != self._version and min(model.version, self._version) < _FRAMES_CHANGED:
            LOG.warning(
                "model '%s' follows the rules of SDF %s but is written into SDF %s; check its frames and joint axes",
                model.name,
                ".".join(map(str, model.version)),
                ".".join(map(str, self._version)),
            )
        made = _placed(absolute_copy(model.element), pose, self._version)
        made.attributes["name"] = model.name
        made.attributes.pop("placement_frame", None)
        return made

    def _light(self, light: Light, source: Element) -> Element:
        if source.tag == "include" and not self._expand:
            return _placed(absolute_copy(source), light.pose, self._version)
        made = _placed(absolute_copy(light.element), light.pose, self._version)
        made.attributes |= {"name": light.name, "type": light.kind}
        for tag, value in (
            ("diffuse", " ".join(map(repr, (*light.diffuse, 1.0)))),
            ("specular", " ".join(map(repr, (*light.specular, 1.0)))),
            ("intensity", repr(light.intensity)),
            ("light_on", str(light.on).lower()),
            ("cast_shadows", str(light.cast_shadows).lower()),
            ("direction", " ".join(map(repr, map(float, light.direction)))),
        ):
            made.children = [child for child in made.children if child.tag != tag]
            made.children.append(Element(tag, text=value))
        return made


def _came_from(element: Element, name: str, child: Element) -> bool:
    """Return whether a model or light was made from this child of `<world>`."""
    if child.tag != "include":
        return element is child
    if child.attributes.get("merge", "false").lower() in ("true", "1"):
        return False  # its content is written out
    if child.text_of("name", name) != name:
        return False
    base = Path(child.file).parent if child.file != "<string>" else None
    try:
        return str(find_model(child.text_of("uri"), base)) == element.file
    except ResourceError:
        return False


def _placed(element: Element, pose: Pose, version: tuple[int, int]) -> Element:
    element.children = [child for child in element.children if child.tag != "pose"]
    element.children.insert(0, pose_element(pose, version))
    return element


def absolute_copy(element: Element) -> Element:
    """Copy an element; a relative `<uri>` becomes absolute, because the text has no file."""
    made = copy.copy(element)
    made.attributes = dict(element.attributes)
    made.children = [absolute_copy(child) for child in element.children]
    if element.tag == "uri" and "://" not in element.text and not element.text.startswith(("/", "<")):
        beside = Path(element.file).resolve().parent / element.text
        if beside.exists():
            made.text = str(beside)
    return made
