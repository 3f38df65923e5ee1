"""A `WorldDescription` becomes a MuJoCo model: links to bodies, joints to joints, shapes to geoms.

Reader -> (here) -> `World`. Names: body and joint `model::link`, collision geom `model::link::name`, visual
geom `model::link::name#visual`, sensor site `model::link::sensor`. Collisions are in geom group 3, visuals in
group 1. Static models have no bodies of their own: their shapes belong to MuJoCo's world body, which is
cheaper to cast rays at.
"""

from __future__ import annotations

import itertools

import mujoco
import numpy as np

from gz.sim.errors import Diagnostics
from gz.sim.physics import recipe
from gz.sim.physics.servos import WHEEL, JointServo, add_servo
from gz.sim.pose import Pose, Vector, matrix, multiply, quaternion_between
from gz.sim.sdf.description import (
    UNLIMITED,
    Axis,
    Collision,
    Geometry,
    Joint,
    Link,
    Model,
    Visual,
    WorldDescription,
)

COLLISION_GROUP = 3
VISUAL_GROUP = 1
SITE_GROUP = 5
VISUAL_SUFFIX = "#visual"

_TYPES = {
    "box": mujoco.mjtGeom.mjGEOM_BOX,
    "sphere": mujoco.mjtGeom.mjGEOM_SPHERE,
    "cylinder": mujoco.mjtGeom.mjGEOM_CYLINDER,
    "capsule": mujoco.mjtGeom.mjGEOM_CAPSULE,
    "ellipsoid": mujoco.mjtGeom.mjGEOM_ELLIPSOID,
    "plane": mujoco.mjtGeom.mjGEOM_PLANE,
}
_JOINT_TYPES = {
    "revolute": mujoco.mjtJoint.mjJNT_HINGE,
    "continuous": mujoco.mjtJoint.mjJNT_HINGE,
    "prismatic": mujoco.mjtJoint.mjJNT_SLIDE,
    "ball": mujoco.mjtJoint.mjJNT_BALL,
}


def build_spec(world: WorldDescription, servos: dict[str, list[JointServo]], diagnostics: Diagnostics) -> mujoco.MjSpec:
    """Return the MuJoCo spec of a world; `servos` lists, per model name, the joints that systems drive."""
    return _Builder(world, servos, diagnostics).build()


def scoped(model: Model, name: str) -> str:
    """Return the MuJoCo name of a model's link or joint."""
    return f"{model.name}::{name}"


class _Builder:
    def __init__(self, world: WorldDescription, servos: dict[str, list[JointServo]], diagnostics: Diagnostics) -> None:
        self._world = world
        self._servos = servos
        self._diagnostics = diagnostics
        self._spec = mujoco.MjSpec()
        self._solref = recipe.contact_solref(world.step_size_ns * 1e-9)
        collisions = [c for model in world.models for link in model.links for c in link.collisions]
        self._ranks = recipe.friction_ranks(collision.mu for collision in collisions)

    def build(self) -> mujoco.MjSpec:
        spec, world = self._spec, self._world
        spec.modelname = world.name
        recipe.apply_options(spec, world.step_size_ns * 1e-9, world.gravity)
        spec.visual.headlight.ambient = world.ambient
        for light in world.lights:
            made = spec.worldbody.add_light(name=light.name, pos=light.pose.position, diffuse=light.diffuse)
            made.dir = matrix(light.pose.quaternion) @ np.asarray(light.direction)
            if light.kind == "directional":
                made.type = mujoco.mjtLightType.mjLIGHT_DIRECTIONAL
        for model in world.models:
            if model.static:
                for link in model.links:
                    self._add_parts(spec.worldbody, model, link, model.pose * link.pose, wheel=False)
            else:
                self._add_tree(model)
        return spec

    def _add_tree(self, model: Model) -> None:
        """Hang the links of a moving model on each other by their joints; links nobody carries float
        freely.
        """
        carried: dict[str, Joint] = {}
        loops: list[Joint] = []
        for joint in model.joints:
            if joint.child in carried or self._closes_circle(joint, carried):
                loops.append(joint)
            else:
                carried[joint.child] = joint
        wheels = {servo.joint for servo in self._servos.get(model.name, []) if servo.kind == WHEEL}
        bodies: dict[str, mujoco.MjsBody] = {}
        waiting = list(model.links)
        while waiting:
            left: list[Link] = []
            for link in waiting:
                carrier = carried.get(link.name)
                if carrier is not None and carrier.parent != "world" and carrier.parent not in bodies:
                    left.append(link)
                    continue
                bodies[link.name] = self._add_body(model, link, carrier, bodies, wheels)
            waiting = left
        for joint in loops:
            self._add_loop(model, joint)
        for servo in self._servos.get(model.name, []):
            add_servo(self._spec, model, servo, scoped(model, servo.joint))
        touching = [link for link in model.links if link.collisions]
        for one, other in itertools.combinations(touching, 2):
            if not (one.self_collide and other.self_collide):
                self._spec.add_exclude(bodyname1=scoped(model, one.name), bodyname2=scoped(model, other.name))

    @staticmethod
    def _closes_circle(joint: Joint, carried: dict[str, Joint]) -> bool:
        link = joint.parent
        while link in carried:
            link = carried[link].parent
            if link == joint.child:
                return True
        return False

    def _add_body(
        self,
        model: Model,
        link: Link,
        joint: Joint | None,
        bodies: dict[str, mujoco.MjsBody],
        wheels: set[str],
    ) -> mujoco.MjsBody:
        if joint is None or joint.parent == "world":
            holder, pose = self._spec.worldbody, model.pose * link.pose
        else:
            parent = model.link(joint.parent)
            assert parent is not None
            holder, pose = bodies[joint.parent], parent.pose.inverse() * link.pose
        body = holder.add_body(name=scoped(model, link.name), pos=pose.position, quat=pose.quaternion)
        if joint is None:
            body.add_freejoint(name=scoped(model, link.name) + "#free")
        elif joint.kind != "fixed":
            self._add_joint(body, model, joint)
        body.gravcomp = 0.0 if link.gravity else 1.0
        self._set_inertia(body, link)
        wheel = joint is not None and joint.name in wheels
        self._add_parts(body, model, link, Pose(), wheel=wheel)
        return body

    @staticmethod
    def _set_inertia(body: mujoco.MjsBody, link: Link) -> None:
        inertial = link.inertial
        if inertial.automatic:
            return
        ixx, iyy, izz, ixy, ixz, iyz = inertial.moments
        moments, axes = np.linalg.eigh(np.array(((ixx, ixy, ixz), (ixy, iyy, iyz), (ixz, iyz, izz))))
        if np.linalg.det(axes) < 0.0:
            axes[:, 0] *= -1.0
        # A flat body has A + B = C exactly; rounding must not make it an impossible one.
        moments[0] += max(0.0, moments[2] - moments[0] - moments[1]) + 1e-7 * moments[2]
        turn = np.zeros(4)
        mujoco.mju_mat2Quat(turn, axes.flatten())
        body.explicitinertial = True
        body.mass = inertial.mass
        body.inertia = moments
        body.ipos = inertial.pose.position
        body.iquat = multiply(inertial.pose.quaternion, turn)

    def _add_joint(self, body: mujoco.MjsBody, model: Model, joint: Joint) -> None:
        made = body.add_joint(name=scoped(model, joint.name), type=_JOINT_TYPES[joint.kind], pos=joint.pose.position)
        axis = joint.axis
        if axis is None:
            return
        made.axis = axis.direction
        made.damping[0] = axis.damping
        made.frictionloss = axis.friction
        made.stiffness[0] = axis.spring_stiffness
        made.springref = axis.spring_reference
        if abs(axis.lower) < UNLIMITED or abs(axis.upper) < UNLIMITED:
            made.limited = mujoco.mjtLimited.mjLIMITED_TRUE
            made.range = _limit_range(axis)
        for servo in self._servos.get(model.name, []):
            if servo.joint == joint.name and servo.kind == WHEEL:
                made.armature = recipe.wheel_armature(model.mass(), servo.sharing, servo.radius)

    def _add_loop(self, model: Model, joint: Joint) -> None:
        """A second joint onto a link closes a loop: it becomes a constraint between two bodies."""
        weld = joint.kind == "fixed"
        constraint = self._spec.add_equality(
            name=scoped(model, joint.name),
            type=mujoco.mjtEq.mjEQ_WELD if weld else mujoco.mjtEq.mjEQ_CONNECT,
            objtype=mujoco.mjtObj.mjOBJ_BODY,
            name1=scoped(model, joint.child),
            name2="world" if joint.parent == "world" else scoped(model, joint.parent),
        )
        if not weld:
            constraint.data[:3] = joint.pose.position
        elif joint.parent != "world":
            child, parent = model.link(joint.child), model.link(joint.parent)
            assert child is not None and parent is not None
            relation = child.pose.inverse() * parent.pose
            constraint.data[:3] = (0.0, 0.0, 0.0)
            constraint.data[3:6] = relation.position
            constraint.data[6:10] = relation.quaternion
            constraint.data[10] = 1.0

    def _add_parts(self, body: mujoco.MjsBody, model: Model, link: Link, base: Pose, *, wheel: bool) -> None:
        name = scoped(model, link.name)
        moving = not model.static
        for collision in link.collisions:
            self._add_collision(body, f"{name}::{collision.name}", base, collision, link, wheel, moving)
        for visual in link.visuals:
            self._add_visual(body, f"{name}::{visual.name}{VISUAL_SUFFIX}", base, visual, moving)
        for sensor in link.sensors:
            pose = base * sensor.pose
            site = body.add_site(name=f"{name}::{sensor.name}", pos=pose.position, quat=pose.quaternion)
            site.group = SITE_GROUP
        for joint in (joint for joint in model.joints if joint.child == link.name):
            for sensor in joint.sensors:
                pose = base * joint.pose * sensor.pose
                place = scoped(model, f"{joint.name}::{sensor.name}")
                body.add_site(name=place, pos=pose.position, quat=pose.quaternion).group = SITE_GROUP

    def _add_collision(
        self,
        body: mujoco.MjsBody,
        name: str,
        base: Pose,
        part: Collision,
        link: Link,
        wheel: bool,
        moving: bool,
    ) -> None:
        geometry = part.geometry
        pose = base * part.pose
        kind, size = geometry.kind, _half_sizes(geometry)
        if wheel and kind == "cylinder":
            # One contact point in the wheel's middle plane: the wheel separation is then exact.
            kind, size = "ellipsoid", (size[0], size[0], size[1])
        if kind == "plane":
            pose = pose * _plane_turn(geometry)
            if moving:
                self._diagnostics.warn(
                    part.element.where, f"a plane cannot move; collision '{part.name}' becomes a thin box"
                )
                kind, size = "box", (geometry.size[0] / 2, geometry.size[1] / 2, 0.001)
            else:
                size = (0.0, 0.0, 1.0)
        geom = body.add_geom(name=name, type=_TYPES[kind], size=_three(size), pos=pose.position, quat=pose.quaternion)
        geom.group = COLLISION_GROUP
        geom.contype = geom.conaffinity = part.bitmask
        geom.solref = self._solref
        geom.priority = self._ranks[part.mu]
        geom.condim = 3 if part.mu > 0.0 else 1
        geom.friction = (max(part.mu, 1e-6), 0.005, 0.0001)
        if moving and link.inertial.automatic:
            geom.density = part.density
        elif moving:
            geom.mass = 0.0

    @staticmethod
    def _add_visual(body: mujoco.MjsBody, name: str, base: Pose, part: Visual, moving: bool) -> None:
        geometry = part.geometry
        pose = base * part.pose
        kind, size = geometry.kind, _half_sizes(geometry)
        if kind == "plane":
            pose = pose * _plane_turn(geometry)
            if moving:
                kind, size = "box", (geometry.size[0] / 2, geometry.size[1] / 2, 0.001)
        geom = body.add_geom(name=name, type=_TYPES[kind], size=_three(size), pos=pose.position, quat=pose.quaternion)
        geom.group = VISUAL_GROUP
        geom.contype = geom.conaffinity = 0
        geom.mass = 0.0
        geom.rgba = part.rgba


def _limit_range(axis: Axis) -> tuple[float, float]:
    lower, upper = max(axis.lower, -1e6), min(axis.upper, 1e6)
    return (lower, upper) if upper - lower > 1e-9 else (lower - 1e-6, upper + 1e-6)


def _plane_turn(geometry: Geometry) -> Pose:
    return Pose((0.0, 0.0, 0.0), quaternion_between((0.0, 0.0, 1.0), geometry.normal))


def _half_sizes(geometry: Geometry) -> tuple[float, ...]:
    x, y, z = (value / 2.0 for value in geometry.size)
    if geometry.kind == "sphere":
        return (x,)
    if geometry.kind in ("cylinder", "capsule"):
        return (x, z)
    if geometry.kind == "plane":
        return (x, y, 1.0)
    return (x, y, z)


def _three(size: tuple[float, ...]) -> Vector:
    return np.array((*size, 0.0, 0.0)[:3])
