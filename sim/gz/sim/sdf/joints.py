"""Reads `<joint>`: the connected links, pose, axes and limits.

Joints of a model are read after all its links (including nested ones), joints of a `<world>` after all its models.

Source: SDFormat, element `<joint>`, http://sdformat.org/spec
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.pose import Pose, matrix
from gz_course.sim.gz.sim.sdf.description import UNLIMITED, Axis, Joint, Mimic, Model
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.sdf.frames import Scope
from gz_course.sim.gz.sim.sdf.sensors import read_joint_sensors

KINDS = ("fixed", "revolute", "continuous", "prismatic", "ball", "universal", "revolute2", "screw", "gearbox")
_ONE_AXIS = frozenset(("revolute", "continuous", "prismatic", "screw"))
_TWO_AXES = frozenset(("universal", "revolute2", "gearbox"))


def read_joint(
    element: Element, scope: Scope, model: Model, version: tuple[int, int], diagnostics: Diagnostics
) -> Joint:
    """Return a joint of a model with scoped link names; pose and axes are in the child link's frame."""
    joint = _joint(element, scope, {link.name: link.pose for link in model.links}, version)
    joint.sensors = read_joint_sensors(joint, scope, model, diagnostics)
    return joint


def read_world_joint(element: Element, scope: Scope, models: list[Model], version: tuple[int, int]) -> Joint:
    """Return a joint of a world; its link names are `model::link`."""
    places = {f"{model.name}::{link.name}": model.pose * link.pose for model in models for link in model.links}
    joint = _joint(element, scope, places, version)
    for axis in (joint.axis, joint.axis2):
        if axis is not None and axis.mimic is not None:
            raise element.error(f"joint '{joint.name}' of a <world> cannot have a <mimic>; put it into a model")
    return joint


def _joint(element: Element, scope: Scope, places: Mapping[str, Pose], version: tuple[int, int]) -> Joint:
    kind = element.attributes.get("type", "")
    if kind not in KINDS:
        hint = did_you_mean(kind, KINDS, listing="known names are")
        raise element.error(f"joint '{element.name}' has type '{kind}'{hint}")
    child = _link(element, "child", scope, places)
    parent = _link(element, "parent", scope, places)
    if child == "world":
        raise element.error(f"joint '{element.name}' has the world as child; the world can only be a parent")
    if child == parent:
        raise element.error(f"joint '{element.name}' connects link '{child}' with itself")
    pose = places[child].inverse() * scope.pose_of(element.name, element)
    joint = Joint(element.name, kind, parent, child, pose, element)
    if kind in _ONE_AXIS or kind in _TWO_AXES:
        joint.axis = _axis(element, "axis", scope, places[child], pose, version)
    if kind in _TWO_AXES:
        joint.axis2 = _axis(element, "axis2", scope, places[child], pose, version)
    if kind == "continuous" and joint.axis is not None:
        joint.axis.lower, joint.axis.upper = -UNLIMITED, UNLIMITED
    if kind == "screw":
        joint.thread_pitch = _thread_pitch(element)
    if kind == "gearbox":
        joint.gearbox_ratio = element.number("gearbox_ratio", 1.0)
        if not abs(joint.gearbox_ratio) < 1e6:
            raise element.error(f"<gearbox_ratio> of joint '{joint.name}' must be finite")
        if element.text_of("gearbox_reference_body"):
            joint.gearbox_reference = _link(element, "gearbox_reference_body", scope, places)
    return joint


def _link(element: Element, role: str, scope: Scope, places: Mapping[str, Pose]) -> str:
    stated = element.find(role)
    if stated is None or not stated.text:
        raise element.error(f"joint '{element.name}' needs a <{role}> that names a link")
    known = {stated.text, stated.text.split("::")[0]} & {"world", "__model__", *scope.frames}
    if not known:
        hint = did_you_mean(stated.text, places, listing="its links are")
        owner = "the world" if scope.own == "world" else f"model '{scope.element.name}'"
        raise stated.error(
            f"<{role}> of joint '{element.name}' names link '{stated.text}', which {owner} does not have{hint}"
        )
    found = scope.link_behind(stated.text, stated)
    if found != "world" and found not in places:
        hint = did_you_mean(found, places, listing="its links are")
        raise stated.error(f"<{role}> of joint '{element.name}' leads to no link ('{found}'){hint}")
    return found


def _thread_pitch(element: Element) -> float:
    """Return the advance of a screw [m per turn], positive for a right-handed thread.

    The older `<thread_pitch>` is in [rad/m] with the opposite sign of `<screw_thread_pitch>`.
    """
    if element.find("screw_thread_pitch") is not None:
        pitch = element.number("screw_thread_pitch", 1.0)
    elif element.find("thread_pitch") is not None:
        old = element.number("thread_pitch", 1.0)
        pitch = -2.0 * math.pi / old if old else math.inf
    else:
        pitch = 1.0
    if not abs(pitch) < 1e6:
        raise element.error(f"the thread pitch of joint '{element.name}' must be finite and not zero")
    return pitch


def _axis(joint: Element, tag: str, scope: Scope, link_pose: Pose, pose: Pose, version: tuple[int, int]) -> Axis:
    element = joint.find(tag)
    if element is None:
        return Axis(_turned(pose, (1.0, 0.0, 0.0) if tag == "axis2" else (0.0, 0.0, 1.0)))
    xyz = element.find("xyz")
    x, y, z = xyz.floats(3) if xyz is not None and xyz.text else (0.0, 0.0, 1.0)
    length = math.hypot(x, y, z)
    if not 1e-9 < length < math.inf:
        raise (xyz or element).error(f"the <xyz> of joint '{joint.name}' has no direction")
    stated = (x / length, y / length, z / length)
    frame = xyz.attributes.get("expressed_in", "") if xyz is not None else ""
    if not frame and (element.flag("use_parent_model_frame", False) or version <= (1, 4)):
        frame = scope.own
    if frame:
        axis = Axis(_turned(link_pose.inverse() * scope.pose_of(frame, xyz or element), stated))
    else:
        axis = Axis(_turned(pose, stated))
    axis.initial_position = _finite(element, "initial_position", joint)
    limit = element.find("limit")
    if limit is not None:
        _read_limit(limit, axis, joint)
    dynamics = element.find("dynamics")
    if dynamics is not None:
        axis.damping = max(0.0, _finite(dynamics, "damping", joint))
        axis.friction = max(0.0, _finite(dynamics, "friction", joint))
        axis.spring_stiffness = max(0.0, _finite(dynamics, "spring_stiffness", joint))
        axis.spring_reference = _finite(dynamics, "spring_reference", joint)
    mimic = element.find("mimic")
    if mimic is not None:
        axis.mimic = _mimic(mimic, joint)
    return axis


def _turned(pose: Pose, direction: tuple[float, float, float]) -> tuple[float, float, float]:
    x, y, z = matrix(pose.quaternion) @ np.array(direction)
    return float(x), float(y), float(z)


def _finite(element: Element, tag: str, joint: Element) -> float:
    value = element.number(tag, 0.0)
    if not abs(value) < 1e15:
        raise (element.find(tag) or element).error(f"<{tag}> of joint '{joint.name}' must be finite")
    return value


def _read_limit(limit: Element, axis: Axis, joint: Element) -> None:
    axis.lower = max(-UNLIMITED, limit.number("lower", -UNLIMITED))
    axis.upper = min(UNLIMITED, limit.number("upper", UNLIMITED))
    effort, velocity = limit.number("effort", math.inf), limit.number("velocity", math.inf)
    axis.effort = effort if effort >= 0.0 else math.inf
    axis.velocity = velocity if velocity >= 0.0 else math.inf
    if axis.lower > axis.upper:
        raise limit.error(f"joint '{joint.name}' has its lower limit above its upper ({axis.lower:g} > {axis.upper:g})")


def _mimic(element: Element, joint: Element) -> Mimic:
    leader = element.attributes.get("joint", "")
    if not leader:
        raise element.error(f"<mimic> of joint '{joint.name}' needs the attribute joint, the name of the one to follow")
    mimic = Mimic(leader, element.attributes.get("axis", "axis"))
    if mimic.axis not in ("axis", "axis2"):
        raise element.error(f"<mimic> of joint '{joint.name}' follows '{mimic.axis}'; it can be axis or axis2")
    mimic.multiplier = _finite_or(element, "multiplier", 1.0)
    mimic.offset = _finite_or(element, "offset", 0.0)
    mimic.reference = _finite_or(element, "reference", 0.0)
    return mimic


def _finite_or(element: Element, tag: str, default: float) -> float:
    value = element.number(tag, default)
    if not abs(value) < 1e9:
        raise (element.find(tag) or element).error(f"<{tag}> must be finite")
    return value


def check_mimics(model: Model) -> None:
    """Check mimic axes. Raises SdfError if the followed joint or axis does not exist, or follows in turn."""
    joints = {joint.name: joint for joint in model.joints}
    leaders: dict[str, str] = {}
    for joint in model.joints:
        for axis in (joint.axis, joint.axis2):
            if axis is None or axis.mimic is None:
                continue
            leader = joints.get(axis.mimic.joint)
            if leader is None:
                hint = did_you_mean(axis.mimic.joint, joints, listing="its joints are")
                raise joint.element.error(
                    f"<mimic> of joint '{joint.name}' names joint '{axis.mimic.joint}', which model "
                    f"'{model.name}' does not have{hint}"
                )
            if (leader.axis if axis.mimic.axis == "axis" else leader.axis2) is None:
                text = f"'{leader.name}' is a {leader.kind} joint without <{axis.mimic.axis}>"
                raise joint.element.error(f"<mimic> of joint '{joint.name}' cannot follow: {text}")
            leaders.setdefault(joint.name, leader.name)
    for start in leaders:
        follower, seen = start, {start}
        while follower in leaders:
            follower = leaders[follower]
            if follower in seen:
                raise joints[start].element.error(f"joint '{start}' follows itself by <mimic>; one of them must lead")
            seen.add(follower)
