"""Lumping of fixed joints: a URDF link on a fixed joint becomes part of its parent link.

As in Gazebo a fixed joint is preserved if a `<gazebo reference="JOINT">` has `preserveFixedJoint` or
`disableFixedJointLumping`, or if its parent is the link `world`.

Source: sdformat 14, `ReduceFixedJoints`, https://github.com/gazebosim/sdformat/blob/sdf14/src/parser_urdf.cc
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass, field

import numpy as np

from gz_course.sim.gz.sim.pose import Pose, matrix
from gz_course.sim.gz.sim.sdf.inertia import point_inertia, tensor
from gz_course.sim.gz.sim.sdf.urdf.robot import WORLD, Robot, UrdfInertial, UrdfJoint, UrdfLink


@dataclass(eq=False)
class Body:
    """One link of the SDF model: the URDF link `head` and the links lumped into it.

    `members` holds the head and these links with their poses in the head's frame, in Gazebo's order (a link, then its
    descendants by the names of the joints).
    """

    head: UrdfLink
    members: list[tuple[UrdfLink, Pose]] = field(default_factory=list)
    joint: UrdfJoint | None = None
    """The joint between `parent` and the head; `origin` is its pose in the frame of `parent`."""
    parent: str = ""
    origin: Pose = field(default_factory=Pose)
    inertial: UrdfInertial | None = None

    @property
    def name(self) -> str:
        """Return the name of the link in the SDF model."""
        return self.head.name


def lump(robot: Robot, preserved: Collection[str]) -> list[Body]:
    """Return the bodies of a robot, parents first; `preserved` names the fixed joints to preserve.

    A root link called `world` is the world itself and not a body.
    """
    bodies: dict[str, Body] = {}
    placed: dict[str, tuple[Body, Pose]] = {}
    for link in robot.below(robot.root):
        joint = link.joint
        if joint is not None and joint.kind == "fixed" and joint.name not in preserved and joint.parent != WORLD:
            body, pose = placed[joint.parent]
            pose = pose * joint.origin
        else:
            body, pose = Body(link, joint=joint), Pose()
            if joint is not None and joint.parent == WORLD:
                body.parent, body.origin = WORLD, joint.origin
            elif joint is not None:
                carrier, offset = placed[joint.parent]
                body.parent, body.origin = carrier.name, offset * joint.origin
            if link.name != WORLD or joint is not None:
                bodies[link.name] = body
        placed[link.name] = (body, pose)
        body.members.append((link, pose))
    for body in bodies.values():
        body.inertial = _lumped_inertial(body)
    return list(bodies.values())


def _lumped_inertial(body: Body) -> UrdfInertial | None:
    """Return the inertia of all members about their centre of mass, along the axes of the head's inertia.

    It is the sum of R_i I_i R_i' + m_i (|c_i|^2 1 - c_i c_i'), moved to the common centre of mass.
    Source: parallel axis theorem, https://en.wikipedia.org/wiki/Parallel_axis_theorem#Tensor_generalization
    """
    parts = [(link.inertial, pose) for link, pose in body.members if link.inertial is not None]
    if not parts:
        return None
    own = body.head.inertial
    if len(parts) == 1 and own is not None:
        return own
    mass = math.fsum(inertial.mass for inertial, _ in parts)
    moment, inertia = np.zeros(3), np.zeros((3, 3))
    for inertial, pose in parts:
        place = pose * inertial.pose
        turn = matrix(place.quaternion)
        moment += inertial.mass * place.position
        inertia += turn @ tensor(inertial.moments) @ turn.T + inertial.mass * point_inertia(place.position)
    centre = moment / mass if mass else np.zeros(3)
    inertia -= mass * point_inertia(centre)
    axes = own.pose.quaternion if own is not None else np.array((1.0, 0.0, 0.0, 0.0))
    turn = matrix(axes)
    (ixx, ixy, ixz), (_, iyy, iyz), (_, _, izz) = (turn.T @ inertia @ turn).tolist()
    element = own.element if own is not None else parts[0][0].element
    return UrdfInertial(mass, (ixx, iyy, izz, ixy, ixz, iyz), Pose(centre, axes), element)
