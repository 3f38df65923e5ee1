"""Runs a scene in DART through `dartpy` (PyPI), built from our own reading of the world with gz-physics' mapping.

Not by dartpy: `mu2`, `fdir1`, `slip1`, `slip2`; a scene with these is left to the plugin.

Source: https://github.com/gazebosim/gz-physics/blob/ign-physics5/dartsim/src/SDFFeatures.cc
"""

from __future__ import annotations

import importlib.util
import math
from typing import Any

import numpy as np

from gz_course.sim.gz.sim.pose import Pose, matrix, rotate
from gz_course.sim.gz.sim.sdf.description import UNLIMITED, Collision, Joint, Link, Model
from gz_course.tests.conformance.physics.orders import read, servos
from gz_course.tests.conformance.physics.scene import Action, Force, Kick, Scene, Servo, Track


def why_absent() -> str:
    """A sentence if dartpy is not installed; empty if it is."""
    return "" if importlib.util.find_spec("dartpy") else "DART was NOT run: pip install 'gz-ros2-course[fidelity]'"


def run(scene: Scene) -> Track:
    description = read(scene)
    world = _World(description.gravity, scene.step)
    for model in description.models:
        world.add(model)
    samples = []
    for actions, steps in scene.phases():
        for action in servos(description, actions):
            world.act(action)
        for _ in range(steps // scene.stride):
            for _ in range(scene.stride):
                world.step()
            sample: list[float] = []
            for name in scene.links:
                sample += world.pose_of(name)
            for name in scene.joints:
                sample += world.joint(name)
            samples.append(sample)
    return scene.track(samples)


class _World:
    def __init__(self, gravity: tuple[float, float, float], step: float) -> None:
        import dartpy

        self._dart = dartpy
        self._world = dartpy.simulation.World()
        self._world.setGravity(gravity)
        self._world.setTimeStep(step)
        awake = self._world.getDeactivationOptions()
        awake.mEnabled = False
        self._world.setDeactivationOptions(awake)
        solver = self._world.getConstraintSolver()
        solver.setCollisionDetector(dartpy.collision.OdeCollisionDetector())
        solver.getCollisionOption().maxNumContacts = 10_000
        self._bodies: dict[str, Any] = {}
        self._joints: dict[str, Any] = {}
        self._forces: dict[str, float] = {}
        self._commands: dict[str, float] = {}

    def add(self, model: Model) -> None:
        skeleton = self._dart.dynamics.Skeleton(model.name)
        waiting = list(model.links)
        while waiting:
            link = waiting.pop(0)
            joint = next((each for each in model.joints if each.child == link.name), None)
            if joint is not None and joint.parent != "world" and f"{model.name}::{joint.parent}" not in self._bodies:
                waiting.append(link)
                continue
            self._add_link(skeleton, model, link, joint)
        if not model.self_collide:
            skeleton.disableSelfCollisionCheck()
        skeleton.setMobile(not model.static)
        self._world.addSkeleton(skeleton)

    def _add_link(self, skeleton: Any, model: Model, link: Link, joint: Joint | None) -> None:
        place = model.pose * link.pose
        if joint is None:
            held = model.static
            make = skeleton.createWeldJointAndBodyNodePair if held else skeleton.createFreeJointAndBodyNodePair
            made, body = make()
            if held:
                made.setTransformFromParentBodyNode(_isometry(place, self._dart))
            else:
                made.setPositions(self._dart.dynamics.FreeJoint.convertToPositions(_isometry(place, self._dart)))
        else:
            make = getattr(skeleton, f"create{_KINDS[joint.kind]}JointAndBodyNodePair")
            parent = self._bodies.get(f"{model.name}::{joint.parent}")
            made, body = make(parent) if parent is not None else make()
            above = model.link(joint.parent)
            base = model.pose * above.pose if above is not None else Pose()
            made.setTransformFromChildBodyNode(_isometry(joint.pose, self._dart))
            made.setTransformFromParentBodyNode(_isometry(base.inverse() * place * joint.pose, self._dart))
            if joint.axis is not None and joint.kind != "fixed":
                _set_axis(made, joint)
            self._joints[f"{model.name}::{joint.name}"] = made
        body.setName(link.name)
        self._bodies[f"{model.name}::{link.name}"] = body
        body.setInertia(_inertia(link, self._dart))
        body.setGravityMode(link.gravity)
        for part in link.collisions:
            self._add_shape(body, part)

    def _add_shape(self, body: Any, part: Collision) -> None:
        dynamics, size = self._dart.dynamics, part.geometry.size
        kind, place = part.geometry.kind, part.pose
        if kind == "box":
            shape = dynamics.BoxShape(size)
        elif kind == "sphere":
            shape = dynamics.SphereShape(size[0] / 2.0)
        elif kind == "cylinder":
            shape = dynamics.CylinderShape(size[0] / 2.0, size[2])
        elif kind == "capsule":
            shape = dynamics.CapsuleShape(size[0] / 2.0, size[2])
        elif kind == "plane":
            shape = dynamics.PlaneShape(part.geometry.normal, 0.0)
        else:
            raise ValueError(f"{kind} of collision '{part.name}'")
        node = body.createShapeNode(shape)
        node.setRelativeTransform(_isometry(place, self._dart))
        node.createCollisionAspect()
        aspect = node.createDynamicsAspect()
        aspect.setFrictionCoeff(part.mu)
        aspect.setRestitutionCoeff(part.restitution)

    def act(self, action: Action) -> None:
        if isinstance(action, Servo):
            self._joints[action.joint].setActuatorType(self._dart.dynamics.ActuatorType.SERVO)
            self._commands[action.joint] = action.value
        elif isinstance(action, Force):
            self._forces[action.joint] = action.value
        elif isinstance(action, Kick):
            body = next(body for name, body in self._bodies.items() if name.startswith(f"{action.model}::"))
            joint = body.getParentJoint()
            turn = body.getTransform().rotation()
            joint.setVelocities(np.concatenate((turn.T @ np.array(action.angular), turn.T @ np.array(action.linear))))

    def step(self) -> None:
        for name, value in self._commands.items():
            self._joints[name].setCommand(0, value)
        for name, value in self._forces.items():
            joint = self._joints[name]
            joint.setForce(0, min(max(value, joint.getForceLowerLimit(0)), joint.getForceUpperLimit(0)))
        self._world.step()

    def pose_of(self, name: str) -> list[float]:
        transform = self._bodies[name].getTransform()
        turn = transform.quaternion()
        return [*transform.translation().ravel().tolist(), turn.w(), turn.x(), turn.y(), turn.z()]

    def joint(self, name: str) -> list[float]:
        joint = self._joints[name]
        return [joint.getPosition(0), joint.getVelocity(0)]


_KINDS = {"revolute": "Revolute", "continuous": "Revolute", "prismatic": "Prismatic", "fixed": "Weld", "ball": "Ball"}


def _set_axis(made: Any, joint: Joint) -> None:
    axis = joint.axis
    assert axis is not None
    made.setAxis(rotate(joint.pose.inverse().quaternion, np.array(axis.direction)))
    made.setDampingCoefficient(0, axis.damping)
    made.setCoulombFriction(0, axis.friction)
    made.setSpringStiffness(0, axis.spring_stiffness)
    made.setRestPosition(0, axis.spring_reference)
    if axis.lower > -UNLIMITED or axis.upper < UNLIMITED:
        made.setPositionLowerLimit(0, axis.lower if axis.lower > -UNLIMITED else -math.inf)
        made.setPositionUpperLimit(0, axis.upper if axis.upper < UNLIMITED else math.inf)
    made.setForceLowerLimit(0, -axis.effort)
    made.setForceUpperLimit(0, axis.effort)
    made.setVelocityLowerLimit(0, -axis.velocity)
    made.setVelocityUpperLimit(0, axis.velocity)
    made.setLimitEnforcement(True)


def _isometry(pose: Pose, dart: Any) -> Any:
    found = dart.math.Isometry3()
    found.set_translation(pose.position)
    found.set_rotation(matrix(pose.quaternion))
    return found


def _inertia(link: Link, dart: Any) -> Any:
    ixx, iyy, izz, ixy, ixz, iyz = link.inertial.moments
    turn = matrix(link.inertial.pose.quaternion)
    moments = turn @ np.array(((ixx, ixy, ixz), (ixy, iyy, iyz), (ixz, iyz, izz))) @ turn.T
    return dart.dynamics.Inertia(link.inertial.mass, link.inertial.pose.position, moments)
