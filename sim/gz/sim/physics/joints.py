"""Adds joints as MuJoCo joints between a body and its parent, or as equality constraints if they close a loop.

Names: the first or only axis is `model::joint`, the second axis of a universal or revolute2 joint the hinge
`model::joint#2`, the slide of a screw `model::joint#slide`, coupled to its hinge by an equality of the same name.
An axis with `initial_position` starts there: the link is moved accordingly, and MuJoCo counts the position from the
pose in the file.

Source: https://mujoco.readthedocs.io/en/stable/computation/index.html (constraint model: equality)
Source: http://sdformat.org/spec?elem=joint
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping

import mujoco
import numpy as np

from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.physics import recipe
from gz_course.sim.gz.sim.pose import Pose, matrix
from gz_course.sim.gz.sim.sdf.description import UNLIMITED, Axis, Joint, Link, Model

AXIS2_SUFFIX = "#2"
SLIDE_SUFFIX = "#slide"
_HINGE, _SLIDE = mujoco.mjtJoint.mjJNT_HINGE, mujoco.mjtJoint.mjJNT_SLIDE
TURNING = frozenset(("revolute", "continuous"))


def displacement(joint: Joint) -> Pose:
    """Return the motion, in the child link's frame, from the pose in the file to the initial position."""
    moved = Pose()
    for axis, slides in _axes(joint):
        if axis.initial_position and slides:
            moved = moved * Pose(axis.initial_position * np.array(axis.direction))
        elif axis.initial_position:
            half = axis.initial_position / 2.0
            turn = Pose(quaternion=(math.cos(half), *(math.sin(half) * np.array(axis.direction))))
            anchor = Pose(joint.pose.position)
            moved = moved * anchor * turn * anchor.inverse()
            if joint.kind == "screw":
                advance = axis.initial_position * joint.thread_pitch / (2.0 * math.pi)
                moved = moved * Pose(advance * np.array(axis.direction))
    return moved


def _axes(joint: Joint) -> list[tuple[Axis, bool]]:
    """Return the axes of a tree joint, each with whether it is prismatic."""
    found = [(joint.axis, joint.kind == "prismatic")] if joint.axis is not None else []
    if joint.kind in ("universal", "revolute2") and joint.axis2 is not None:
        found.append((joint.axis2, False))
    return found if joint.kind not in ("fixed", "ball", "gearbox") else []


def add_joint(spec: mujoco.MjSpec, body: mujoco.MjsBody, name: str, joint: Joint, armature: float, step: float) -> None:
    """Add a joint of the tree to the body of its child; `armature` [kg m^2] is the rotor inertia of its servo."""
    if joint.kind == "ball":
        body.add_joint(name=name, type=mujoco.mjtJoint.mjJNT_BALL, pos=joint.pose.position)
        return
    for number, (axis, slides) in enumerate(_axes(joint)):
        made = body.add_joint(name=name + (AXIS2_SUFFIX if number else ""), type=_SLIDE if slides else _HINGE)
        made.pos = joint.pose.position
        made.axis = axis.direction
        made.ref = axis.initial_position
        made.damping[0] = axis.damping
        if axis.friction > 0.0:
            made.frictionloss = axis.friction
            made.solref_friction = recipe.joint_solref(step)
            made.solimp_friction[:2] = recipe.JOINT_FRICTION_IMPEDANCE
        made.stiffness[0] = axis.spring_stiffness
        made.springref = axis.spring_reference
        made.armature = 0.0 if number else armature
        if abs(axis.lower) < UNLIMITED or abs(axis.upper) < UNLIMITED:
            made.limited = mujoco.mjtLimited.mjLIMITED_TRUE
            made.range = _range(axis)
            made.solref_limit = recipe.joint_solref(step)
    if joint.kind == "screw" and joint.axis is not None:
        advance = joint.thread_pitch / (2.0 * math.pi)
        slide = body.add_joint(
            name=name + SLIDE_SUFFIX, type=_SLIDE, pos=joint.pose.position, axis=joint.axis.direction
        )
        slide.ref = advance * joint.axis.initial_position
        _couple(spec, name + SLIDE_SUFFIX, name + SLIDE_SUFFIX, name, (0.0, advance), step)


def _range(axis: Axis) -> tuple[float, float]:
    lower, upper = max(axis.lower, -1e6), min(axis.upper, 1e6)
    return (lower, upper) if upper - lower > 1e-9 else (lower - 1e-6, upper + 1e-6)


def _couple(spec: mujoco.MjSpec, name: str, follower: str, leader: str, line: tuple[float, float], step: float) -> None:
    """Constrain follower = line[0] + line[1] * leader; both are counted from their start."""
    equality = spec.add_equality(name=name, type=mujoco.mjtEq.mjEQ_JOINT, objtype=mujoco.mjtObj.mjOBJ_JOINT)
    equality.name1, equality.name2 = follower, leader
    equality.data[:5] = (*line, 0.0, 0.0, 0.0)
    equality.solref = recipe.joint_solref(step)
    equality.solimp[:2] = (0.99, 0.999)


def add_mimics(spec: mujoco.MjSpec, model: Model, built: Mapping[str, Joint], step: float) -> None:
    """Couple the mimic axes; `built` holds the joints of the tree by MuJoCo name."""
    for joint in model.joints:
        for axis, suffix in ((joint.axis, ""), (joint.axis2, AXIS2_SUFFIX)):
            if axis is None or axis.mimic is None or f"{model.name}::{joint.name}" not in built:
                continue
            mimic = axis.mimic
            leader = built.get(f"{model.name}::{mimic.joint}")
            led = None if leader is None else leader.axis if mimic.axis == "axis" else leader.axis2
            if led is None or (suffix and joint.kind == "gearbox"):
                continue
            start = mimic.offset + mimic.multiplier * (led.initial_position - mimic.reference) - axis.initial_position
            follower = f"{model.name}::{joint.name}{suffix}"
            other = f"{model.name}::{mimic.joint}{AXIS2_SUFFIX if mimic.axis == 'axis2' else ''}"
            _couple(spec, f"{follower}#mimic", follower, other, (start, mimic.multiplier), step)


def gears(model: Model, joint: Joint, hinges: Iterable[Joint]) -> tuple[str, str, float] | None:
    """Return the names of the follower and the leader of a gearbox among the `hinges` of the tree, and their ratio.

    Child angle = -gearbox ratio * parent angle, both relative to the reference body. None if the links do not turn on
    that body.
    """
    candidates = list(hinges)
    ends: list[tuple[str, float]] = []
    for link, axis in ((joint.child, joint.axis2), (joint.parent, joint.axis)):
        both = {link, joint.gearbox_reference}
        found = next((h for h in candidates if h.kind in TURNING and {h.parent, h.child} == both), None)
        if found is None or axis is None or found.axis is None:
            return None
        along = float(np.dot(_in_model(model, found.child, found.axis), _in_model(model, joint.child, axis)))
        ends.append((found.name, math.copysign(1.0, along) * (1.0 if found.child == link else -1.0)))
    (follower, one), (leader, other) = ends
    return follower, leader, -joint.gearbox_ratio * one * other


def add_gearbox(spec: mujoco.MjSpec, model: Model, joint: Joint, found: tuple[str, str, float], step: float) -> None:
    """Couple the two hinges returned by `gears`."""
    follower, leader, ratio = found
    name = f"{model.name}::{joint.name}"
    _couple(spec, name, f"{model.name}::{follower}", f"{model.name}::{leader}", (0.0, ratio), step)


def _in_model(model: Model, link: str, axis: Axis) -> np.ndarray:
    found = model.link(link)
    assert found is not None
    return np.asarray(matrix(found.pose.quaternion) @ np.array(axis.direction))


def add_loop(
    spec: mujoco.MjSpec,
    name: str,
    joint: Joint,
    child: tuple[str, Pose],
    parent: tuple[str, Pose],
    diagnostics: Diagnostics,
) -> None:
    """Constrain two bodies for a joint onto a link that another joint already carries.

    A fixed joint becomes a weld, any other a connect constraint at the position of the joint. `child` and `parent` are
    body names (`world` for static links) with the poses of the links in these bodies.
    """
    if joint.kind in ("prismatic", "screw"):
        text = (
            f"{joint.kind} joint '{joint.name}' closes a loop, which only fixed and turning joints can; it is left out"
        )
        diagnostics.warn(joint.element.where, text)
        return
    weld = joint.kind == "fixed"
    constraint = spec.add_equality(
        name=name,
        type=mujoco.mjtEq.mjEQ_WELD if weld else mujoco.mjtEq.mjEQ_CONNECT,
        objtype=mujoco.mjtObj.mjOBJ_BODY,
        name1=child[0],
        name2=parent[0],
    )
    place = child[1] * joint.pose
    constraint.data[:3] = (0.0, 0.0, 0.0) if weld else place.position


def link_map(models: Iterable[Model]) -> dict[str, tuple[Model, Link]]:
    """Return every link of a world by `model::link`."""
    return {f"{model.name}::{link.name}": (model, link) for model in models for link in model.links}
