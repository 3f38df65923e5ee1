"""Reads `<model>`: links, joints, frames, plugins and nested models, flattened into one `Model`.

Source: SDFormat, element `<model>`, http://sdformat.org/spec
"""

from __future__ import annotations

from gz_course.sim.gz.sim.errors import Diagnostics, SdfError
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.sdf.description import Model, NestedModel, Plugin
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.sdf.frames import Scope
from gz_course.sim.gz.sim.sdf.includes import Includes, Opened, merged_children
from gz_course.sim.gz.sim.sdf.joints import check_mimics, read_joint
from gz_course.sim.gz.sim.sdf.links import read_link

_UNIQUE_NAMES, _NESTED_MODELS = (1, 7), (1, 8)  # the versions of SDF that brought them
Placed = tuple[Model, Scope, Pose, str]
"""A model, its scope, its pose in the file, and the frame of that pose."""
_UNHEARD = {
    "gripper": "grippers of Gazebo Classic are not simulated; use the DetachableJoint system",
    "enable_wind": "",
    "allow_auto_disable": "",
}


def pose_and_base(element: Element) -> tuple[Pose, str]:
    """Return an element's own `<pose>` and the frame it is relative to (empty: the default one)."""
    pose = element.find("pose")
    if pose is None:
        return Pose(), ""
    return pose.pose(), pose.attributes.get("relative_to", "") or pose.attributes.get("frame", "")


def read_plugin(element: Element) -> Plugin:
    """Return a `<plugin>`. Raises SdfError if it has neither name nor filename."""
    name, filename = element.name, element.attributes.get("filename", "")
    if not name and not filename:
        raise element.error("<plugin> needs filename and name, for example name='gz::sim::systems::DiffDrive'")
    return Plugin(name, filename, element)


class ModelReader:
    """Reads the models of one world; holds the includes and the diagnostics for all levels."""

    def __init__(self, includes: Includes, diagnostics: Diagnostics) -> None:
        self._includes = includes
        self._diagnostics = diagnostics

    def read(self, opened: Opened, static: bool = False) -> Placed:
        """Return a flattened model with its scope and its pose in the file; `static` is inherited from its parent."""
        element = opened.element
        if not element.name:
            raise element.error("<model> needs a name attribute")
        static = static or element.flag("static", False)
        model = Model(element.name, Pose(), element, static, element.flag("self_collide", False))
        model.version = opened.version
        scope = Scope("__model__", element, flat_names=opened.version < _NESTED_MODELS)
        parts: list[Opened] = []
        nested: list[tuple[str, Model]] = []
        for part in self._parts(opened, static):
            child = part.element
            if child.tag == "model":
                inner, inner_scope, pose, base = self.read(part, static)
                scope.add(child.name, part.place, pose=pose, relative_to=base, nested=inner_scope)
                nested.append((child.name, inner))
            elif child.tag in ("link", "frame", "joint"):
                if part.version < _UNIQUE_NAMES:
                    _rename(child, scope, self._diagnostics)
                add_frame(scope, child)
                parts.append(part)
            elif child.tag == "plugin":
                model.plugins.append(read_plugin(child))
            elif child.tag == "light":
                self._diagnostics.warn(
                    child.where, f"light '{child.name}' belongs into a <link> or the world, it is left out"
                )
            elif _UNHEARD.get(child.tag):
                self._diagnostics.warn(child.where, _UNHEARD[child.tag])
        for part in parts:
            if part.element.tag == "link":
                model.links.append(read_link(part.element, scope, model, self._diagnostics, self._includes.resources))
        for name, inner in nested:
            _flatten(model, inner, name, scope.pose_of(name, inner.element))
        if model.links:
            model.canonical_link = scope.canonical_link(element)
        for part in parts:
            joint = part.element
            if joint.tag == "joint" and not joint_to_skipped(joint, scope, self._includes, self._diagnostics):
                model.joints.append(read_joint(joint, scope, model, part.version, self._diagnostics))
        check_mimics(model)
        if self._includes.found_all:  # else a base may be what was not found
            scope.check()
        pose, base = pose_and_base(element)
        placement = element.attributes.get("placement_frame", "")
        if placement:
            pose = pose * scope.pose_of(placement, element).inverse()
        return model, scope, pose, base

    def _parts(self, opened: Opened, static: bool) -> list[Opened]:
        """Return the children of a model with opened includes and the children of merged includes."""
        found: list[Opened] = []
        for child in opened.element.children:
            part = self._includes.open(child, opened.version, opened.chain)
            if part is None:
                continue
            if not part.merged:
                found.append(part)
                continue
            if part.element.tag != "model":
                raise child.error(f"a <{part.element.tag}> cannot be merged into a model; leave merge away")
            found.extend(self.merged(part, static))
        return found

    def merged(self, part: Opened, static: bool = False, *, world: bool = False) -> list[Opened]:
        """Return the children of a merged include, which become children of the model or, with `world`, of the
        world.
        """
        if part.element.tag == "world":
            children = merged_children(part, Pose(), "", "", world=True)
        else:
            # The model is read once for the pose of its frame; its children are read again in their new scope.
            model, _, pose, base = self.read(part, static)
            children = merged_children(part, pose, base, model.canonical_link, world=world)
        made: list[Opened] = []
        for child in children:
            inner = self._includes.open(child, part.version, part.chain)
            if inner is not None:
                made.extend(self.merged(inner, static, world=world) if inner.merged else [inner])
        return made


def joint_to_skipped(joint: Element, scope: Scope, includes: Includes, diagnostics: Diagnostics) -> bool:
    """Return whether a joint is left out, because it refers to a model whose include was skipped or joins two frames
    of one link; warn if so.
    """
    for role in ("parent", "child"):
        first = joint.text_of(role).split("::")[0]
        if (first in includes.skipped and first not in scope.frames) or first in includes.empty:
            diagnostics.warn(joint.where, f"joint '{joint.name}' is skipped with the include '{first}'")
            return True
    parent, child = joint.text_of("parent"), joint.text_of("child")
    if parent == child:
        return False
    try:
        link, other = scope.link_behind(parent, joint), scope.link_behind(child, joint)
    except SdfError:  # the reader of the joint says what is wrong
        return False
    if link == other:
        text = f"joint '{joint.name}' is left out: '{parent}' and '{child}' are both part of link '{link}'"
        diagnostics.warn(joint.where, text)
    return link == other


def _rename(element: Element, scope: Scope, diagnostics: Diagnostics) -> None:
    """Give a link, joint or frame another name if it has that of one of another kind before it, as libsdformat does."""
    if element.name not in scope.frames or scope.frames[element.name].element.tag == element.tag:
        return
    first, name, number = element.name, f"{element.name}_{element.tag}", 0
    while name in scope.frames:
        name, number = f"{first}_{element.tag}{number}", number + 1
    taken = scope.frames[first].element
    diagnostics.warn(
        element.where,
        f"<{element.tag}> '{first}' has the name of the <{taken.tag}> at {taken.where}; it is now '{name}'",
    )
    element.attributes["name"] = name


def add_frame(scope: Scope, element: Element) -> None:
    """Register a link, frame or joint in the scope."""
    pose, base = pose_and_base(element)
    if element.tag == "link":
        scope.add(element.name, element, pose=pose, relative_to=base, is_link=True)
    elif element.tag == "frame":
        attached = element.attributes.get("attached_to", "")
        scope.add(element.name, element, pose=pose, relative_to=base or attached, attached_to=attached)
    else:
        child = element.text_of("child")
        scope.add(element.name, element, pose=pose, relative_to=base or child, attached_to=child)


def _flatten(model: Model, inner: Model, name: str, pose: Pose) -> None:
    """Move the parts of a nested model into its parent and prefix every name with `name::`."""
    for link in inner.links:
        link.name = f"{name}::{link.name}"
        link.pose = pose * link.pose
        link.self_collide = link.self_collide or inner.self_collide
        for sensor in link.sensors:
            sensor.link = link.name
            sensor.model = model.name
        model.links.append(link)
    canonical = f"{name}::{inner.canonical_link}" if inner.canonical_link else ""
    model.nested.append(NestedModel(name, pose, inner.element, canonical))
    for nested in inner.nested:
        canonical = f"{name}::{nested.canonical_link}" if nested.canonical_link else ""
        model.nested.append(NestedModel(f"{name}::{nested.name}", pose * nested.pose, nested.element, canonical))
    for joint in inner.joints:
        joint.name = f"{name}::{joint.name}"
        joint.child = f"{name}::{joint.child}"
        joint.parent = joint.parent if joint.parent == "world" else f"{name}::{joint.parent}"
        if joint.gearbox_reference not in ("", "world"):
            joint.gearbox_reference = f"{name}::{joint.gearbox_reference}"
        for axis in (joint.axis, joint.axis2):
            if axis is not None and axis.mimic is not None:
                axis.mimic.joint = f"{name}::{axis.mimic.joint}"
        for sensor in joint.sensors:
            sensor.joint, sensor.link, sensor.model = joint.name, joint.child, model.name
        model.joints.append(joint)
    for plugin in inner.plugins:
        plugin.scope = f"{name}::{plugin.scope}" if plugin.scope else name
        model.plugins.append(plugin)
