"""MecanumDrive: drives a model with four mecanum wheels forward, sideways and round.

`Twist` on `/model/M/cmd_vel` (linear.x, linear.y, angular.z) -> limits -> four wheel speeds -> MuJoCo servos. As in
Gazebo a command takes effect one step after it is received and holds without a timeout. The odometry of the wheels is
published on `/model/M/odometry` and `/model/M/tf`, as by Gazebo 9; Gazebo 8 only advertises it.

Gazebo needs `<fdir1>` and `<mu2>` 0 on the wheels; here their rollers are part of the system: friction moves each wheel
over the ground with the velocity that belongs to the speeds of all four.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/mecanum_drive/MecanumDrive.cc
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.driving.odometry_reports import OdometryReports
from gz_course.sim.gz.sim.driving.speed_limiter import SpeedLimiter, limit_parameters
from gz_course.sim.gz.sim.physics import surface_motion
from gz_course.sim.gz.sim.physics.contacts import CollisionGeoms
from gz_course.sim.gz.sim.physics.pushes import cross
from gz_course.sim.gz.sim.physics.servos import WHEEL, Drive, JointServo, find_drive
from gz_course.sim.gz.sim.plugins.model_scope import ModelScope
from gz_course.sim.gz.sim.plugins.system import System, UpdateInfo, system
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.sim.pose import Vector, matrix, rotate
from gz_course.sim.gz.sim.sdf.description import Joint, Model, Plugin
from gz_course.sim.gz.sim.sdf.element import Element

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node

_CORNERS = ("front_left_joint", "front_right_joint", "back_left_joint", "back_right_joint")
_FORWARD = np.array((1.0, 1.0, 1.0, 1.0))
_LEFTWARD = np.array((-1.0, 1.0, 1.0, -1.0))
_ROUND = np.array((-1.0, 1.0, -1.0, 1.0))


@system("MecanumDrive", "gz-sim-mecanum-drive-system")
class MecanumDrive(System):
    """Drives one model. Parameters and defaults are Gazebo's."""

    parameters = frozenset(
        (
            *limit_parameters("linear", "angular"),
            *_CORNERS,
            *("wheel_separation", "wheelbase", "wheel_radius", "topic"),
            *OdometryReports.parameters,
        )
    )

    @classmethod
    def servos(cls, model: Model, plugin: Plugin) -> list[JointServo]:
        """Request a velocity servo for every wheel joint. Raises SdfError for a joint that does not exist."""
        radius = _positive(plugin.element, "wheel_radius", 0.2)
        joints = [joint for corner in _CORNERS for joint in _joints(model, plugin, corner)]
        return [JointServo(joint.name, WHEEL, radius, len(joints)) for joint in joints]

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        element = plugin.element
        self.world = world
        self.scope = ModelScope(world, model, plugin, self.name)
        self._requests = {servo.joint: servo for servo in self.servos(self.scope.model, plugin)}
        self._corners = [_joints(self.scope.model, plugin, corner) for corner in _CORNERS]
        self._radius = _positive(element, "wheel_radius", 0.2)
        self._length = (_positive(element, "wheel_separation", 1.0) + _positive(element, "wheelbase", 1.0)) / 2.0
        self._limit_linear = SpeedLimiter.from_sdf(element, "linear")
        self._limit_angular = SpeedLimiter.from_sdf(element, "angular")
        self.topic = valid_topic(element.text_of("topic"), f"/model/{self.scope.name}/cmd_vel")
        self.reports = OdometryReports(self.scope, element)

    def bind(self) -> None:
        """Find the servos, the bodies and the shapes of the wheels."""
        model, scope = self.world.model, self.scope
        surface_motion.prepare(self.world)
        shapes = CollisionGeoms(self.world).paths
        self._drives: list[list[Drive]] = []
        self._geoms: dict[int, tuple[int, Vector, int]] = {}
        self._bodies: list[int] = []
        for joints in self._corners:
            found = [find_drive(model, scope.model, self._requests[joint.name]) for joint in joints]
            self._drives.append([drive for drive in found if drive is not None])
            for joint, drive in zip(joints, found, strict=True):
                if drive is None or joint.axis is None:
                    continue
                body = scope.body(joint.child)
                self._bodies.append(body)
                for geom, path in shapes.items():
                    if path[:2] == (scope.model.name, joint.child):
                        self._geoms[geom] = body, np.array(joint.axis.direction), drive.axis.velocity

    def start(self) -> None:
        self._target = self._last = self._before_last = (0.0, 0.0, 0.0)
        self._speeds = np.zeros(4)
        self._places: Vector | None = None
        self.x = self.y = self.heading = 0.0
        self.reports.start()

    def connect(self, node: Node) -> None:
        from gz_course.sim.gz.msgs.twist_pb2 import Twist

        node.subscribe(Twist, self.topic, self._on_command)
        self.reports.connect(node)

    def command(self, forward: float, left: float, angular: float) -> bool:
        """Set the commanded velocities [m/s] and yaw rate [rad/s]; return False if they are refused."""
        values = (forward, left, angular)
        if not all(map(math.isfinite, values)):
            self.world.drop_command(self.topic, f"linear.x={forward}, linear.y={left}, angular.z={angular}")
            return False
        self._target = (
            min(max(forward, -1e9), 1e9),
            min(max(left, -1e9), 1e9),
            min(max(angular, -1e9), 1e9),
        )
        return True

    def _on_command(self, message: Any) -> None:
        self.command(message.linear.x, message.linear.y, message.angular.z)

    def pre_update(self, info: UpdateInfo) -> None:
        for drives, speed in zip(self._drives, self._speeds.tolist(), strict=True):
            for drive in drives:
                drive.hold(self.world.data, speed, info.dt)

    def in_step(self, info: UpdateInfo) -> None:
        """Move the wheels over the ground as their rollers do."""
        if not self._geoms or not self.world.data.ncon:
            return
        data = self.world.data
        turning = [self._mean([data.qvel[drive.axis.velocity] for drive in drives]) for drives in self._drives]
        forward, left, angular = self._twist(np.array(turning))
        x, y, up = matrix(self.scope.world_pose().quaternion).T
        middle = data.xpos[self._bodies].mean(axis=0)
        moved, turned = forward * x + left * y, angular * up

        def motion(geom: int, point: Vector, inward: Vector) -> Vector:
            body, axis, dof = self._geoms[geom]
            rolling = data.qvel[dof] * cross(rotate(data.xquat[body], axis), point - data.xpos[body])
            return moved + cross(turned, point - middle) + rolling

        surface_motion.move(self.world, self._geoms, motion)

    def post_update(self, info: UpdateInfo) -> None:
        """Compute the next wheel speeds; update the odometry and publish it when due."""
        last, before = self._last, self._before_last
        limits = (self._limit_linear, self._limit_linear, self._limit_angular)
        wanted = [
            limit.limit(target, now, earlier, info.dt)
            for limit, target, now, earlier in zip(limits, self._target, last, before, strict=True)
        ]
        self._before_last, self._last = last, (wanted[0], wanted[1], wanted[2])
        turn = wanted[2] * self._length
        self._speeds = (wanted[0] * _FORWARD + wanted[1] * _LEFTWARD + turn * _ROUND) / self._radius
        places = np.array(
            [self._mean([self.world.data.qpos[drive.axis.position] for drive in drives]) for drives in self._drives]
        )
        moved = self._twist(places - (places if self._places is None else self._places))
        self._places = places
        middle = self.heading + moved[2] / 2.0
        self.x += moved[0] * math.cos(middle) - moved[1] * math.sin(middle)
        self.y += moved[0] * math.sin(middle) + moved[1] * math.cos(middle)
        self.heading += moved[2]
        if self.reports.due(info.sim_time_ns):
            forward, left, angular = (each / info.dt for each in moved)
            self.reports.publish(info.sim_time_ns, (self.x, self.y, self.heading), forward, angular, left)

    def _twist(self, turns: Vector) -> tuple[float, float, float]:
        """Return how far forward, left [m] and round [rad] the angles (4,) [rad] of the wheels move the model."""
        share = self._radius / 4.0
        return (
            float(_FORWARD @ turns) * share,
            float(_LEFTWARD @ turns) * share,
            float(_ROUND @ turns) * share / self._length,
        )

    @staticmethod
    def _mean(values: list[float]) -> float:
        return sum(values) / len(values) if values else 0.0


def _joints(model: Model, plugin: Plugin, corner: str) -> list[Joint]:
    found: list[Joint] = []
    prefix = f"{plugin.scope}::" if plugin.scope else ""
    for element in plugin.element.all(corner):
        joint = model.joint(prefix + element.text)
        if joint is None or joint.kind not in ("revolute", "continuous"):
            known = [each.name.removeprefix(prefix) for each in model.joints]
            text = f"MecanumDrive's <{corner}> names '{element.text}', which is not a revolute joint of '{model.name}'"
            raise element.error(text + did_you_mean(element.text, known, listing="its joints are"))
        found.append(joint)
    if not found:
        raise plugin.element.error(f"MecanumDrive needs at least one <{corner}>, none was found")
    return found


def _positive(element: Element, tag: str, default: float) -> float:
    value = element.number(tag, default)
    if not 0.0 < value < math.inf:
        raise element.error(f"MecanumDrive's <{tag}> must be greater than zero, got {value:g}")
    return value
