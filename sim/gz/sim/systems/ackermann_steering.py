"""AckermannSteering: drives a car with steered front wheels from velocity commands, and computes its odometry.

`Twist` on `/model/M/cmd_vel` -> limits -> turning radius -> speed of each driven wheel and angle of each steered one
-> servos; after each step wheel angles -> odometry on `/model/M/odometry` and `/model/M/tf`. With `<steering_only>`
the only input is a steering angle (`Double` on `/model/M/steer_angle`, or an entry of `Actuators`). As in Gazebo the
steering joints turn with `<steer_p_gain>` times the angle error.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/ackermann_steering/AckermannSteering.cc
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.driving.odometry_reports import OdometryReports
from gz_course.sim.gz.sim.driving.speed_limiter import SpeedLimiter, limit_parameters
from gz_course.sim.gz.sim.physics.servos import MAX_WHEEL_SPEED, VELOCITY, WHEEL, Drive, JointServo, find_drive
from gz_course.sim.gz.sim.plugins.model_scope import ModelScope
from gz_course.sim.gz.sim.plugins.system import System, UpdateInfo, system
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.sim.sdf.description import Model, Plugin
from gz_course.sim.gz.sim.sdf.element import Element

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node

STRAIGHT = 0.001
"""Turning rates [rad/s] below this value mean straight driving."""
_WHEELS = ("left_joint", "right_joint")
_STEERING = ("left_steering_joint", "right_steering_joint")
_SIZES = {
    "wheel_separation": 1.0,
    "kingpin_width": 0.8,
    "wheel_base": 1.0,
    "steering_limit": 0.5,
    "wheel_radius": 0.2,
}


@system("AckermannSteering", "gz-sim-ackermann-steering-system")
class AckermannSteering(System):
    """Drives one car. Parameters and defaults are Gazebo's: lengths in [m], `<steering_limit>` in [rad]."""

    parameters = frozenset(
        (
            *_WHEELS,
            *_STEERING,
            *_SIZES,
            *limit_parameters(),
            *OdometryReports.parameters,
            "topic",
            "sub_topic",
            "steering_only",
            "steer_p_gain",
            "use_actuator_msg",
            "actuator_number",
        )
    )

    @classmethod
    def servos(cls, model: Model, plugin: Plugin) -> list[JointServo]:
        """Request servos for the driven and the steered joints. Raises SdfError for a joint that does not exist or
        turn.
        """
        element = plugin.element
        steered = [joint for tag in _STEERING for joint in _joints(model, plugin, tag)]
        found = [JointServo(joint, VELOCITY) for joint in steered]
        if element.flag("steering_only", False):
            return found
        driven = [joint for tag in _WHEELS for joint in _joints(model, plugin, tag)]
        radius = element.number("wheel_radius", _SIZES["wheel_radius"])
        return found + [JointServo(joint, WHEEL, radius, len(driven)) for joint in driven]

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        """Read the parameters. Raises SdfError for sizes that are not positive."""
        element = plugin.element
        self.world = world
        self.scope = scope = ModelScope(world, model, plugin, self.name)
        sizes = {tag: _positive(element, tag, default) for tag, default in _SIZES.items()}
        self._separation, self._kingpin = sizes["wheel_separation"], sizes["kingpin_width"]
        self._base, self._radius = sizes["wheel_base"], sizes["wheel_radius"]
        self._steering_limit = min(sizes["steering_limit"], math.pi / 2)
        self._steering_only = element.flag("steering_only", False)
        # Gazebo's default gain applies to steering only; for driving it is 1 unless it is stated.
        self._gain = _positive(element, "steer_p_gain", 1.0)
        self._limit_linear = SpeedLimiter.from_sdf(element, "linear")
        self._limit_angular = SpeedLimiter.from_sdf(element, "angular")
        self._steered = [_joints(scope.model, plugin, tag) for tag in _STEERING]
        self._driven = [] if self._steering_only else [_joints(scope.model, plugin, tag) for tag in _WHEELS]
        self._actuator_number = -1
        if self._steering_only and element.flag("use_actuator_msg", False):
            self._actuator_number = element.integer("actuator_number", -1)
            if self._actuator_number < 0:
                text = (
                    "AckermannSteering has <use_actuator_msg> but no <actuator_number> of 0 or more; it listens to a "
                )
                world.diagnostics.warn(element.where, f"{text}Double")
        own = "steer_angle" if self._steering_only else "cmd_vel"
        default = "/actuators" if self._actuator_number >= 0 else f"/model/{scope.name}/{own}"
        sub_topic = element.text_of("sub_topic")
        self.command_topic = valid_topic(
            element.text_of("topic"), f"/model/{scope.name}/{sub_topic}" if sub_topic else "", default
        )
        self.reports = OdometryReports(scope, element)

    def bind(self) -> None:
        model, mj_model = self.scope.model, self.world.model

        def found(sides: list[list[str]], kind: str) -> list[list[Drive]]:
            drives = ([find_drive(mj_model, model, JointServo(joint, kind)) for joint in side] for side in sides)
            return [[drive for drive in side if drive is not None] for side in drives]

        self._wheels = found(self._driven, WHEEL)
        self._steering = found(self._steered, VELOCITY)
        self._complete = all(self._steering) and all(self._wheels)

    def start(self) -> None:
        self._target = (0.0, 0.0)
        self._angle = 0.0
        self._last = self._before_last = (0.0, 0.0)
        self._wheel_speeds = (0.0, 0.0)
        self._steering_speeds = (0.0, 0.0)
        self._x = self._y = self._heading = 0.0
        self._old_angles = (0.0, 0.0)
        self.reports.start()

    def connect(self, node: Node) -> None:
        if self._actuator_number >= 0:
            from gz_course.sim.gz.msgs.actuators_pb2 import Actuators

            node.subscribe(Actuators, self.command_topic, self._on_actuators)
        elif self._steering_only:
            from gz_course.sim.gz.msgs.double_pb2 import Double

            node.subscribe(Double, self.command_topic, self._on_angle)
        else:
            from gz_course.sim.gz.msgs.twist_pb2 import Twist

            node.subscribe(Twist, self.command_topic, self._on_twist)
            self.reports.connect(node)

    def command(self, linear: float, angular: float) -> bool:
        """Set the commanded forward speed [m/s] and yaw rate [rad/s]; return False if they are refused."""
        if not (math.isfinite(linear) and math.isfinite(angular)):
            self.world.drop_command(self.command_topic, f"linear.x={linear}, angular.z={angular}")
            return False
        self._target = (min(max(linear, -1e4), 1e4), min(max(angular, -1e4), 1e4))
        return True

    def steer(self, angle: float) -> bool:
        """Set the commanded steering angle [rad] of `<steering_only>`; return False if it is refused."""
        if not math.isfinite(angle):
            self.world.drop_command(self.command_topic, f"data={angle}")
            return False
        self._angle = angle
        return True

    def _on_twist(self, message: Any) -> None:
        self.command(message.linear.x, message.angular.z)

    def _on_angle(self, message: Any) -> None:
        self.steer(message.data)

    def _on_actuators(self, message: Any) -> None:
        if self._actuator_number < len(message.position):
            self.steer(message.position[self._actuator_number])
            return
        text = f"a message on {self.command_topic} holds {len(message.position)} positions; AckermannSteering of model "
        text += f"'{self.scope.full_name}' looks for number {self._actuator_number} (counted from 0)"
        self.world.diagnostics.warn("", text)

    def pre_update(self, info: UpdateInfo) -> None:
        """Write the speeds computed after the last step to the servos."""
        if not self._complete:
            return
        data, dt = self.world.data, info.dt
        for side, speed in zip(self._wheels, self._wheel_speeds, strict=False):
            for drive in side:
                drive.hold(data, speed, dt)
        for side, speed in zip(self._steering, self._steering_speeds, strict=True):
            for drive in side:
                drive.hold(data, speed, dt)

    def post_update(self, info: UpdateInfo) -> None:
        """Compute the next speeds; update the odometry and publish it when due."""
        if not self._complete:
            return
        if self._steering_only:
            self._turn_to(self._single_angles())
            return
        self._turn_to(self._driving_angles(info.dt))
        self._reckon(info)

    def _driving_angles(self, dt: float) -> tuple[float, float]:
        """Set the wheel speeds for the limited command; return the left and right steering angle [rad]."""
        last, before = self._last, self._before_last
        linear = self._limit_linear.limit(self._target[0], last[0], before[0], dt)
        angular = self._limit_angular.limit(self._target[1], last[1], before[1], dt)
        self._before_last, self._last = last, (linear, angular)
        if abs(angular) < STRAIGHT:
            curvature = 0.0
        else:
            # Below its minimum turning radius the car turns as sharply as possible, to the commanded side.
            radius = linear / angular
            smallest = self._base / math.sin(self._steering_limit)
            side = radius if radius != 0.0 else angular
            curvature = 1.0 / math.copysign(max(abs(radius), smallest), side)
        lean = self._base * curvature
        half = self._kingpin / 2.0 * curvature
        share = self._separation * curvature / 2.0
        self._wheel_speeds = (linear * (1.0 - share) / self._radius, linear * (1.0 + share) / self._radius)
        if max(map(abs, self._wheel_speeds)) > MAX_WHEEL_SPEED:
            text = f"a command on {self.command_topic} asks for wheels faster than {MAX_WHEEL_SPEED:g} rad/s"
            self.world.diagnostics.warn("", f"{text}; they are held at that speed")
        return math.atan2(lean, 1.0 - half), math.atan2(lean, 1.0 + half)

    def _single_angles(self) -> tuple[float, float]:
        """Return the left and right steering angle [rad] for one commanded angle."""
        angle = min(max(self._angle, -self._steering_limit), self._steering_limit)
        ahead, aside = 2.0 * self._base * math.cos(angle), self._separation * math.sin(angle)
        across = 2.0 * self._base * math.sin(angle)
        return math.atan(across / (ahead - aside)), math.atan(across / (ahead + aside))

    def _turn_to(self, angles: tuple[float, float]) -> None:
        data = self.world.data
        left, right = (
            self._gain * (angle - side[0].axis.read_position(data))
            for side, angle in zip(self._steering, angles, strict=True)
        )
        self._steering_speeds = (left, right)

    def _reckon(self, info: UpdateInfo) -> None:
        """Update the odometry with the bicycle model, steered by the mean of both angles."""
        data = self.world.data
        left, right = (side[0].axis.read_position(data) for side in self._wheels)
        steering = 0.5 * sum(side[0].axis.read_position(data) for side in self._steering)
        distance = 0.5 * self._radius * (left - self._old_angles[0] + right - self._old_angles[1])
        turned = distance * math.tan(steering) / self._base
        self._old_angles = (left, right)
        self._heading = math.remainder(self._heading + turned, 2.0 * math.pi)
        self._x += distance * math.cos(self._heading)
        self._y += distance * math.sin(self._heading)
        if self.reports.due(info.sim_time_ns):
            pose = (self._x, self._y, self._heading)
            self.reports.publish(info.sim_time_ns, pose, distance / info.dt, turned / info.dt)


def _joints(model: Model, plugin: Plugin, tag: str) -> list[str]:
    prefix = f"{plugin.scope}::" if plugin.scope else ""
    found: list[str] = []
    for child in plugin.element.all(tag):
        joint = model.joint(prefix + child.text)
        if joint is None:
            known = [each.name.removeprefix(prefix) for each in model.joints]
            hint = did_you_mean(child.text, known, listing="its joints are")
            text = f"AckermannSteering's <{tag}> names joint '{child.text}', which model '{model.name}' does not have"
            raise child.error(f"{text}{hint}")
        if joint.kind not in ("revolute", "continuous"):
            raise child.error(f"AckermannSteering's <{tag}> '{child.text}' is a {joint.kind} joint; it must turn")
        found.append(joint.name)
    if not found:
        raise plugin.element.error(f"AckermannSteering needs at least one <{tag}>, none was found")
    return found


def _positive(element: Element, tag: str, default: float) -> float:
    value = element.number(tag, default)
    if not 0.0 < value < math.inf:
        raise element.error(f"AckermannSteering's <{tag}> must be greater than zero, got {value}")
    return value
