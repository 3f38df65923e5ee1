"""Builds the MuJoCo spec of a `WorldDescription`: one body for each moving link, nested along its joints.

`geoms` adds shapes, `joints` joints, `lights` lights. Names: body and joint `model::link`, collision geom
`model::link::name`, visual geom `model::link::name#visual`, sensor site `model::link::sensor`, free joint
`model::link#free`. Collisions are in geom group 3, visuals in group 1. Shapes of static models belong to MuJoCo's
world body, which makes ray casting cheaper.

Source: https://mujoco.readthedocs.io/en/stable/programming/modeledit.html (model editing)
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field

import mujoco
import numpy as np

from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.physics import recipe
from gz_course.sim.gz.sim.physics.contact_pairs import add_pairs
from gz_course.sim.gz.sim.physics.geoms import COLLISION_GROUP, SITE_GROUP, VISUAL_GROUP, VISUAL_SUFFIX, Geoms, Wheel
from gz_course.sim.gz.sim.physics.joint_limits import tell_what_stands
from gz_course.sim.gz.sim.physics.joints import (
    add_gearbox,
    add_joint,
    add_loop,
    add_mimics,
    displacement,
    gears,
    link_map,
)
from gz_course.sim.gz.sim.physics.lights import add_light
from gz_course.sim.gz.sim.physics.materials import add_sky
from gz_course.sim.gz.sim.physics.servos import WHEEL, JointServo, add_servo
from gz_course.sim.gz.sim.physics.static_parts import StaticParts
from gz_course.sim.gz.sim.pose import Pose, multiply
from gz_course.sim.gz.sim.sdf.description import Joint, Link, Model, WorldDescription

__all__ = ["COLLISION_GROUP", "SITE_GROUP", "VISUAL_GROUP", "VISUAL_SUFFIX", "build_spec", "scoped"]

DEEPEST = 1000
"""Maximum length of a chain of links; MuJoCo allows no more."""
MOST_TOUCHING = 2000
"""Maximum number of links with collisions in one model, because every pair of them is excluded from contacts by name.
"""
MOST_MOVING = 10_000
"""Maximum number of moving links in a world; the time of compilation grows with its square (20 s for this number)."""
_MANY_LINKS = 300
_WORKSPACE = (1 << 29, 1 << 18)
"""MuJoCo's memory for a large world [byte], and the addition for each link. MuJoCo's default grows with the square of
the number of links: 14 GB for 3000 boxes, which use 40 MB.
"""


def build_spec(world: WorldDescription, servos: dict[str, list[JointServo]], diagnostics: Diagnostics) -> mujoco.MjSpec:
    """Return the MuJoCo spec of a world; `servos` lists, by model name, the joints that systems drive."""
    return _Builder(world, servos, diagnostics).build()


def scoped(model: Model, name: str) -> str:
    """Return the MuJoCo name of a model's link or joint."""
    return f"{model.name}::{name}"


@dataclass(eq=False)
class _Edge:
    """A joint of the world or of a model and the MuJoCo names of its two links; `world` stands for static links."""

    name: str
    joint: Joint
    parent: str
    child: str
    model: Model | None


@dataclass(eq=False)
class _Tree:
    """The kinematic tree of a world.

    It holds the joint that carries each link, the remaining joints, which close loops, the gearboxes with the hinges
    they couple, and the joints that became MuJoCo joints.
    """

    carried: dict[str, _Edge] = field(default_factory=dict)
    loops: list[_Edge] = field(default_factory=list)
    geared: list[tuple[_Edge, tuple[str, str, float]]] = field(default_factory=list)
    built: dict[str, Joint] = field(default_factory=dict)


class _Builder:
    def __init__(self, world: WorldDescription, servos: dict[str, list[JointServo]], diagnostics: Diagnostics) -> None:
        self._world = world
        self._servos = servos
        self._diagnostics = diagnostics
        self._step = world.step_size_ns * 1e-9
        self._bounces = any(
            part.restitution > 0.0 for m in world.models for link in m.links for part in link.collisions
        )
        self._spec = mujoco.MjSpec()
        self._geoms = Geoms(self._spec, world, diagnostics)
        self._links = link_map(world.models)
        self._bodies: dict[str, mujoco.MjsBody] = {}
        self._tree = _Tree()
        self._static_parts = StaticParts(self._spec, world)

    def build(self) -> mujoco.MjSpec:
        spec, world = self._spec, self._world
        spec.modelname = world.name
        moving = sum(not model.static for model, _ in self._links.values())
        if moving > MOST_MOVING:
            raise world.element.error(
                f"the world has {moving} links that move, more than {MOST_MOVING}; make some static"
            )
        if len(self._links) > _MANY_LINKS:
            spec.memory = _WORKSPACE[0] + _WORKSPACE[1] * len(self._links)
        recipe.apply_options(spec, self._step, world.gravity, bounces=self._bounces)
        spec.visual.headlight.ambient = world.ambient
        add_sky(spec, world)
        for light in world.lights:
            add_light(spec.worldbody, light.name, Pose(), light)
        self._choose_tree()
        self._add_bodies()
        self._static_parts.finish()
        for edge in self._tree.loops:
            self._close(edge)
        for edge, found in self._tree.geared:
            assert edge.model is not None
            add_gearbox(spec, edge.model, edge.joint, found, self._step)
        for model in world.models:
            if not model.static:
                self._finish(model)
        add_pairs(spec, self._geoms.shapes, self._step)
        return spec

    def _is_fixed(self, link: str) -> bool:
        """Tell whether a link (`model::link`) belongs to MuJoCo's world body."""
        return link == "world" or self._links[link][0].static

    def _edges(self) -> list[_Edge]:
        found = []
        for model in self._world.models:
            for joint in model.joints:
                parent = joint.parent if joint.parent == "world" else scoped(model, joint.parent)
                found.append(_Edge(scoped(model, joint.name), joint, parent, scoped(model, joint.child), model))
        for joint in self._world.joints:
            if joint.child in self._links and (joint.parent == "world" or joint.parent in self._links):
                found.append(_Edge(joint.name, joint, joint.parent, joint.child, None))
        return [edge for edge in found if not (self._is_fixed(edge.child) and self._is_fixed(edge.parent))]

    def _choose_tree(self) -> None:
        """Choose the first joint onto a link to carry it; further ones close loops.

        A gearbox whose hinges are missing carries its link like a fixed joint if no other joint does.
        """
        carried = self._tree.carried
        for edge in sorted(self._edges(), key=lambda each: each.joint.kind == "gearbox"):
            held = self._is_fixed(edge.child) or self._links[edge.child][1].static
            taken = edge.child in carried or held or self._closes_circle(edge)
            if edge.joint.kind == "gearbox":
                turns = self._gear(edge)
                if turns or taken:
                    continue
            if taken:
                self._tree.loops.append(edge)
            else:
                carried[edge.child] = edge

    def _gear(self, edge: _Edge) -> bool:
        """Tell whether both hinges of a gearbox are in the tree; they are coupled after all joints have been built."""
        hinges = [other.joint for other in self._tree.carried.values() if other.model is edge.model]
        found = None if edge.model is None else gears(edge.model, edge.joint, hinges)
        if found is None:
            self._diagnostics.warn(
                edge.joint.element.where,
                f"gearbox '{edge.joint.name}' needs revolute joints from its <gearbox_reference_body> to both links; "
                "it does not turn",
            )
            return False
        self._tree.geared.append((edge, found))
        return True

    def _closes_circle(self, edge: _Edge) -> bool:
        link = edge.parent
        while link in self._tree.carried:
            link = self._tree.carried[link].parent
            if link == edge.child:
                return True
        return False

    def _add_bodies(self) -> None:
        """Add all bodies, each after its parent; a link without a carrying joint gets a free joint."""
        hanging: dict[str, list[str]] = {}
        roots: list[str] = []
        for name in self._links:
            edge = self._tree.carried.get(name)
            if edge is None or self._is_fixed(edge.parent):
                roots.append(name)
            else:
                hanging.setdefault(edge.parent, []).append(name)
        for root in roots:
            waiting = [(root, 1)]
            while waiting:
                name, depth = waiting.pop()
                model, link = self._links[name]
                if depth > DEEPEST:
                    text = f"more than {DEEPEST} links hang on each other in a row at link '{link.name}'"
                    raise link.element.error(f"{text}; physics cannot take that")
                self._add_link(name, model, link)
                waiting.extend((each, depth + 1) for each in reversed(hanging.get(name, [])))

    def _add_link(self, name: str, model: Model, link: Link) -> None:
        if model.static:
            self._add_parts(self._static_parts, model, link, model.pose * link.pose)
            return
        edge = self._tree.carried.get(name)
        pose = model.pose * link.pose
        holder = self._spec.worldbody
        if edge is not None and edge.parent in self._bodies:
            holder = self._bodies[edge.parent]
            above, parent = self._links[edge.parent]
            # Poses within one model do not involve the world pose, so they stay exact far from the origin.
            pose = parent.pose.inverse() * (link.pose if above is model else above.pose.inverse() * pose)
        if edge is not None:
            pose = pose * displacement(edge.joint)
        body = self._bodies[name] = holder.add_body(name=name, pos=pose.position, quat=pose.quaternion)
        wheel = None
        if edge is not None:
            wheels = (s for s in self._servos.get(model.name, []) if s.kind == WHEEL)
            servo = next((s for s in wheels if s.joint == edge.joint.name), None)
            armature = 0.0
            if servo is not None and edge.joint.axis is not None:
                wheel = Wheel(servo.skids, np.array(edge.joint.axis.direction))
            if servo is not None and self._bounces:
                armature = recipe.wheel_armature(model.mass(), servo.sharing, servo.radius)
            add_joint(self._spec, body, edge.name, edge.joint, armature, self._step)
            if edge.joint.kind not in ("fixed", "gearbox"):
                self._tree.built[edge.name] = edge.joint
        elif not link.static:
            body.add_freejoint(name=name + "#free")
        body.gravcomp = 0.0 if link.gravity else 1.0
        self._set_inertia(body, link)
        drags = (edge is None or edge.joint.kind == "fixed") and self._is_driven(model)
        self._add_parts(body, model, link, Pose(), wheel=wheel, drags=drags)

    def _is_driven(self, model: Model) -> bool:
        """Tell whether a model has driven wheels."""
        return any(servo.kind == WHEEL for servo in self._servos.get(model.name, []))

    @staticmethod
    def _set_inertia(body: mujoco.MjsBody, link: Link) -> None:
        inertial = link.inertial
        ixx, iyy, izz, ixy, ixz, iyz = inertial.moments
        moments, axes = np.linalg.eigh(np.array(((ixx, ixy, ixz), (ixy, iyy, iyz), (ixz, iyz, izz))))
        if np.linalg.det(axes) < 0.0:
            axes[:, 0] *= -1.0
        # For a flat body A + B = C; rounding must not violate MuJoCo's triangle inequality.
        moments[0] += max(0.0, moments[2] - moments[0] - moments[1]) + 1e-7 * moments[2]
        turn = np.zeros(4)
        mujoco.mju_mat2Quat(turn, axes.flatten())
        body.explicitinertial = True
        body.mass = inertial.mass
        body.inertia = moments
        body.ipos = inertial.pose.position
        body.iquat = multiply(inertial.pose.quaternion, turn)

    def _close(self, edge: _Edge) -> None:
        ends = [self._end(edge.child), self._end(edge.parent)]
        add_loop(self._spec, edge.name, edge.joint, ends[0], ends[1], self._diagnostics)

    def _end(self, link: str) -> tuple[str, Pose]:
        if link == "world":
            return "world", Pose()
        model, found = self._links[link]
        return ("world", model.pose * found.pose) if model.static else (link, Pose())

    def _finish(self, model: Model) -> None:
        """Add what requires the complete model: couplings, servos and contact exclusions."""
        own = {scoped(model, joint.name) for joint in model.joints}
        built = {name: joint for name, joint in self._tree.built.items() if name in own}
        add_mimics(self._spec, model, built, self._step)
        tell_what_stands(model, self._servos.get(model.name, []), self._diagnostics)
        for servo in self._servos.get(model.name, []):
            add_servo(self._spec, model, servo, scoped(model, servo.joint), soft=self._bounces)
        touching = [link for link in model.links if link.collisions]
        if len(touching) > MOST_TOUCHING:
            text = f"model '{model.name}' has {len(touching)} links with collisions, more than {MOST_TOUCHING}"
            raise model.element.error(f"{text}; split it into several models")
        jointed = {frozenset((joint.parent, joint.child)) for joint in model.joints}
        skeletons = {link.name: self._skeleton(scoped(model, link.name)) for link in touching}
        for one, other in itertools.combinations(touching, 2):
            touch = one.self_collide or other.self_collide or skeletons[one.name] != skeletons[other.name]
            if not touch or frozenset((one.name, other.name)) in jointed:
                self._spec.add_exclude(bodyname1=scoped(model, one.name), bodyname2=scoped(model, other.name))

    def _skeleton(self, link: str) -> str:
        """Return the (nested) model that a link moves with.

        Links of one model that are not connected by joints can touch each other.
        """
        while link in self._tree.carried and self._tree.carried[link].parent != "world":
            link = self._tree.carried[link].parent
        return link.rpartition("::")[0]

    def _add_parts(
        self,
        body: mujoco.MjsBody | StaticParts,
        model: Model,
        link: Link,
        base: Pose,
        *,
        wheel: Wheel | None = None,
        drags: bool = False,
    ) -> None:
        name = scoped(model, link.name)
        moving = not model.static
        for collision in link.collisions:
            self._geoms.add_collision(
                body,
                f"{name}::{collision.name}",
                base,
                collision,
                model,
                wheel=wheel,
                moving=moving and not link.static,
                drags=drags,
            )
        for visual in link.visuals:
            self._geoms.add_visual(body, f"{name}::{visual.name}", base, visual, moving=moving and not link.static)
        for light in link.lights:
            add_light(body, f"{name}::{light.name}", base, light)
        for sensor in link.sensors:
            pose = base * sensor.pose
            site = body.add_site(name=f"{name}::{sensor.name}", pos=pose.position, quat=pose.quaternion)
            site.group = SITE_GROUP
        for joint in (joint for joint in model.joints if joint.child == link.name):
            for sensor in joint.sensors:
                pose = base * joint.pose * sensor.pose
                place = scoped(model, f"{joint.name}::{sensor.name}")
                body.add_site(name=place, pos=pose.position, quat=pose.quaternion).group = SITE_GROUP
