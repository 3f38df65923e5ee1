"""Forward kinematics of a URDF: transforms from parent link to child link by joint positions.

`publisher.StatePublisher` reads the description with `Kinematics.from_urdf` and calls `transforms` for joint states. A
transform is the joint's `<origin>`, then its motion along or about `<axis>`.

Source: http://wiki.ros.org/urdf/XML/joint
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.sdf.element import Element, parse
from gz_course.sim.gz.sim.sdf.urdf.robot import UrdfJoint, numbers, read_robot
from gz_course.sim.gz.sim.sdf.urdf.xacro_file import restore_places

_TURNING = ("revolute", "continuous")
_MOVING = (*_TURNING, "prismatic")


@dataclass(frozen=True)
class Transform:
    """The pose of frame `child` in frame `parent`: position [m] and quaternion (w, x, y, z)."""

    parent: str
    child: str
    pose: Pose


@dataclass(frozen=True)
class Mimic:
    """The rule of a joint whose position is `multiplier * position of joint + offset` [rad] or [m]."""

    joint: str
    multiplier: float
    offset: float


@dataclass(frozen=True)
class MovingJoint:
    """A revolute, continuous or prismatic joint; `axis` is a unit vector in the joint's frame."""

    name: str
    parent: str
    child: str
    origin: Pose
    axis: tuple[float, float, float]
    turns: bool
    mimic: Mimic | None = None

    def transform(self, position: float) -> Transform:
        """Return the transform of the child link at a joint position [rad] or [m]."""
        x, y, z = self.axis
        if self.turns:
            sine = math.sin(position / 2.0)
            motion = Pose((0.0, 0.0, 0.0), (math.cos(position / 2.0), x * sine, y * sine, z * sine))
        else:
            motion = Pose((x * position, y * position, z * position))
        return Transform(self.parent, self.child, self.origin * motion)


@dataclass
class Kinematics:
    """The joints of a robot; `moving` has them by name, `warnings` tells which joints are not published."""

    name: str
    root: str
    fixed: list[Transform] = field(default_factory=list)
    moving: dict[str, MovingJoint] = field(default_factory=dict)
    warnings: list[str] = field(default_factory=list)

    @classmethod
    def from_urdf(cls, text: str, file: str = "<robot_description>") -> Kinematics:
        """Read a URDF text; `file` is for error sentences. Raises SdfError with file and line."""
        element = parse(text, file)
        restore_places(element)
        if element.tag != "robot":
            raise element.error(f"the outermost element of a URDF must be <robot>, got <{element.tag}>")
        diagnostics = Diagnostics(strict=True)  # strict: collect warnings without logging them
        robot = read_robot(element, diagnostics)
        made = cls(robot.name, robot.root, warnings=diagnostics.warnings)
        for joint in robot.joints.values():
            made._add(joint)
        made._check_mimics(robot.joints)
        return made

    def _add(self, joint: UrdfJoint) -> None:
        if joint.kind in _MOVING:
            self.moving[joint.name] = MovingJoint(
                joint.name, joint.parent, joint.child, joint.origin, _axis(joint), joint.kind in _TURNING, _mimic(joint)
            )
        elif joint.kind == "floating":
            self.warnings.append(
                f"{joint.element.where}: joint '{joint.name}' is floating; its transform is not published here"
            )
        else:
            if joint.kind != "fixed":
                self.warnings.append(f"{joint.element.where}: {joint.kind} joint '{joint.name}' is treated as fixed")
            self.fixed.append(Transform(joint.parent, joint.child, joint.origin))

    def _check_mimics(self, joints: Mapping[str, UrdfJoint]) -> None:
        for name, joint in self.moving.items():
            if joint.mimic is None:
                continue
            leader = self.moving.get(joint.mimic.joint)
            place: Element = joints[name].element
            if leader is None:
                hint = did_you_mean(joint.mimic.joint, self.moving, listing="joints that move are")
                raise place.error(f"joint '{name}' mimics '{joint.mimic.joint}', which is no joint that moves{hint}")
            if leader.mimic is not None:
                raise place.error(f"joint '{name}' mimics '{leader.name}', which mimics another; name that one")

    def transforms(self, positions: Mapping[str, float]) -> list[Transform]:
        """Return the transforms of the joints at these positions [rad] or [m], and of joints that mimic them.

        Names that the robot does not have are ignored.
        """
        return [
            joint.transform(position)
            for joint in self.moving.values()
            if (position := _position(joint, positions)) is not None
        ]


def _position(joint: MovingJoint, positions: Mapping[str, float]) -> float | None:
    if joint.mimic is None:
        return positions.get(joint.name)
    leader = positions.get(joint.mimic.joint)
    return None if leader is None else joint.mimic.multiplier * leader + joint.mimic.offset


def _axis(joint: UrdfJoint) -> tuple[float, float, float]:
    element = joint.element.find("axis")
    x, y, z = numbers(element, "xyz", 3) if element is not None else (1.0, 0.0, 0.0)
    length = math.hypot(x, y, z)
    if not length > 0.0:
        raise joint.element.error(f"the <axis> of joint '{joint.name}' has no direction")
    return x / length, y / length, z / length


def _mimic(joint: UrdfJoint) -> Mimic | None:
    element = joint.element.find("mimic")
    if element is None:
        return None
    leader = element.attributes.get("joint", "")
    if not leader:
        raise element.error("<mimic> needs the attribute joint")
    return Mimic(leader, numbers(element, "multiplier", 1, (1.0,))[0], numbers(element, "offset", 1, (0.0,))[0])
