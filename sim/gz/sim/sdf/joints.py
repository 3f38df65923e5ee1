"""`<joint>`: which links it connects, where it stands, about which axis it moves.

Part of the reader, called after the links of the model (nested ones included) are known.
"""

from __future__ import annotations

import math

import numpy as np

from gz.sim.errors import Diagnostics, nearest
from gz.sim.pose import Pose, matrix
from gz.sim.sdf.description import UNLIMITED, Axis, Joint, Model
from gz.sim.sdf.element import Element
from gz.sim.sdf.frames import Scope
from gz.sim.sdf.sensors import read_joint_sensors

KINDS = ("fixed", "revolute", "continuous", "prismatic", "ball")
_SDF_ONLY = ("universal", "revolute2", "screw", "gearbox")


def read_joint(
    element: Element, scope: Scope, model: Model, version: tuple[int, int], diagnostics: Diagnostics
) -> Joint:
    """Return the joint with scoped link names; its pose and axis are in the child link's frame."""
    kind = element.attributes.get("type", "")
    if kind in _SDF_ONLY:
        diagnostics.warn(element.where, f"joint type '{kind}' is not simulated here, '{element.name}' is held fixed")
        kind = "fixed"
    elif kind not in KINDS:
        raise element.error(f"joint '{element.name}' has type '{kind}'; {nearest(kind, (*KINDS, *_SDF_ONLY))}")
    child = _link(element, "child", scope, model)
    parent = _link(element, "parent", scope, model)
    if child == "world":
        raise element.error(f"joint '{element.name}' has the world as child; the world can only be a parent")
    if child == parent:
        raise element.error(f"joint '{element.name}' connects link '{child}' with itself")
    child_link = next(link for link in model.links if link.name == child)
    pose = child_link.pose.inverse() * scope.pose_of(element.name, element)
    joint = Joint(element.name, kind, parent, child, pose, element)
    joint.sensors = read_joint_sensors(joint, scope, model, diagnostics)
    if kind in ("revolute", "continuous", "prismatic"):
        axis = element.find("axis")
        joint.axis = (
            _axis(axis, element, scope, child_link.pose, pose, version) if axis is not None else Axis((0, 0, 1))
        )
        if kind == "continuous":
            joint.axis.lower, joint.axis.upper = -UNLIMITED, UNLIMITED
    return joint


def _link(element: Element, role: str, scope: Scope, model: Model) -> str:
    stated = element.find(role)
    if stated is None or not stated.text:
        raise element.error(f"joint '{element.name}' needs a <{role}> that names a link")
    if stated.text not in ("world", "__model__") and stated.text.split("::")[0] not in scope.frames:
        names = [link.name for link in model.links]
        hint = nearest(stated.text, names, listing="its links are")
        raise stated.error(
            f"<{role}> of joint '{element.name}' names link '{stated.text}', "
            f"which model '{model.name}' does not have; {hint}"
        )
    return scope.link_behind(stated.text, stated)


def _axis(
    element: Element, joint: Element, scope: Scope, link_pose: Pose, pose: Pose, version: tuple[int, int]
) -> Axis:
    xyz = element.find("xyz")
    stated = np.array(xyz.floats(3) if xyz is not None and xyz.text else (0.0, 0.0, 1.0))
    length = float(np.linalg.norm(stated))
    if not math.isfinite(length) or length < 1e-9:
        raise element.error(f"the <xyz> of joint '{joint.name}' has no direction")
    frame = xyz.attributes.get("expressed_in", "") if xyz is not None else ""
    if not frame and (element.flag("use_parent_model_frame", False) or version <= (1, 4)):
        frame = scope.own
    if frame:
        turned = matrix(scope.pose_of(frame, xyz or element).quaternion) @ (stated / length)
        direction = matrix(link_pose.quaternion).T @ turned
    else:
        direction = matrix(pose.quaternion) @ (stated / length)
    axis = Axis((float(direction[0]), float(direction[1]), float(direction[2])))
    limit = element.find("limit")
    if limit is not None:
        axis.lower = max(-UNLIMITED, limit.number("lower", -UNLIMITED))
        axis.upper = min(UNLIMITED, limit.number("upper", UNLIMITED))
        effort = limit.number("effort", math.inf)
        axis.effort = effort if effort >= 0.0 else math.inf
        if axis.lower > axis.upper:
            raise limit.error(f"joint '{joint.name}' has its lower limit above its upper ({axis.lower} > {axis.upper})")
    dynamics = element.find("dynamics")
    if dynamics is not None:
        axis.damping = max(0.0, dynamics.number("damping", 0.0))
        axis.friction = max(0.0, dynamics.number("friction", 0.0))
        axis.spring_stiffness = max(0.0, dynamics.number("spring_stiffness", 0.0))
        axis.spring_reference = dynamics.number("spring_reference", 0.0)
    return axis
