"""DiffDrive: turns velocity commands into wheel speeds and wheel angles into odometry.

`Twist` on `/model/M/cmd_vel` -> target -> limits -> wheel speeds -> MuJoCo servos; after each step wheel
angles -> odometry on `/model/M/odometry` and `/model/M/tf`. As in Gazebo a command takes effect one step
after it is taken, holds for ever (there is no watchdog), and only `linear.x` and `angular.z` count.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from gz.sim.errors import nearest
from gz.sim.physics.servos import WHEEL, JointServo
from gz.sim.pose import Vector, rotate
from gz.sim.sdf.description import Model, Plugin
from gz.sim.sdf.element import Element
from gz.sim.systems.model_scope import ModelScope
from gz.sim.systems.registry import System, UpdateInfo, system
from gz.sim.systems.speed_limiter import SpeedLimiter
from gz.sim.systems.topics import valid_topic
from gz.sim.systems.wheel_odometry import WheelOdometry

if TYPE_CHECKING:
    from gz.sim.world import World
    from gz.transport import Node

MAX_WHEEL_SPEED = 200.0
"""Fastest a wheel is ever asked to turn (rad/s); beyond any real wheel, and beyond it no step of 1 ms is
exact.
"""

_LIMITS = [
    f"{bound}_{axis}{quantity}"
    for bound in ("min", "max")
    for axis in ("", "linear_", "angular_")
    for quantity in ("velocity", "acceleration", "jerk")
]


@system("DiffDrive", "gz-sim-diff-drive-system")
class DiffDrive(System):
    """Drives one model with a left and a right side of wheels. Parameters and defaults are Gazebo's."""

    parameters = frozenset(
        [
            *_LIMITS,
            "left_joint",
            "right_joint",
            "wheel_separation",
            "wheel_radius",
            "odom_publish_frequency",
            "topic",
            "odom_topic",
            "tf_topic",
            "frame_id",
            "child_frame_id",
        ]
    )

    @classmethod
    def servos(cls, model: Model, plugin: Plugin) -> list[JointServo]:
        """Ask for a velocity servo on every wheel joint; raise `SdfError` for joints the model does not
        have.
        """
        left, right = (_joints(model, plugin, side) for side in ("left_joint", "right_joint"))
        radius = _positive(plugin.element, "wheel_radius", 0.2)
        wheels = left + right
        return [JointServo(joint, WHEEL, radius, len(wheels)) for joint in wheels]

    def configure(self, world: World, model: Model | None, plugin: Plugin) -> None:
        """Read the parameters; `model` must not be None."""
        scope = ModelScope(world, model, plugin, self.name)
        model = scope.model
        element = plugin.element
        self._world = world
        separation = _positive(element, "wheel_separation", 1.0)
        radius = _positive(element, "wheel_radius", 0.2)
        self._half_separation = separation / 2.0
        self._radius = radius
        self._limit_linear = SpeedLimiter.from_sdf(element, "linear")
        self._limit_angular = SpeedLimiter.from_sdf(element, "angular")
        self._limited = not (self._limit_linear.unlimited and self._limit_angular.unlimited)
        frequency = element.number("odom_publish_frequency", 50.0)
        self._odometry_period_ns = int(1e9 / frequency) if frequency > 0.0 and math.isfinite(frequency) else 0
        name = scope.name
        self.command_topic = valid_topic(element.text_of("topic"), f"/model/{name}/cmd_vel")
        self.enable_topic = valid_topic(f"/model/{name}/enable")
        self.odometry_topic = valid_topic(element.text_of("odom_topic"), f"/model/{name}/odometry")
        self.tf_topic = valid_topic(element.text_of("tf_topic"), f"/model/{name}/tf")
        self.frame_id = element.text_of("frame_id", f"{name}/odom")
        base = scope.own_name(scope.canonical_link).replace("::", "/")
        self.child_frame_id = element.text_of("child_frame_id", f"{name}/{base}")
        self._model = model
        self._sides = [_joints(model, plugin, side) for side in ("left_joint", "right_joint")]
        for side in self._sides:
            if _skids(model, side, radius):
                text = (
                    f"DiffDrive of model '{scope.full_name}' has wheels one behind the other, so it must skid to turn; "
                )
                text += (
                    "tyres here grip alike in all directions (<slip1>, <slip2> and <mu2> do not count), expect it to "
                )
                text += "turn with a third of the commanded rate; two driven wheels and casters turn as commanded"
                world.diagnostics.warn(element.where, text)
                break
        self._odometry = WheelOdometry(separation, radius)
        self._publisher: Any = None
        self._tf_publisher: Any = None

    def bind(self) -> None:
        """Find the wheels."""
        self._left, self._right = (
            [self._world.joint_address(self._model, joint) for joint in side] for side in self._sides
        )

    def start(self) -> None:
        """Stand still, enabled, at the origin of the odometry."""
        self._started = False
        self._last_published_ns = 0
        self._target = (0.0, 0.0)
        self._last = (0.0, 0.0)
        self._before_last = (0.0, 0.0)
        self._left_speed = self._right_speed = 0.0
        self._written: tuple[float, float] | None = None
        self._enabled = True

    def connect(self, node: Node) -> None:
        """Subscribe to commands, advertise odometry."""
        from gz.msgs.boolean_pb2 import Boolean
        from gz.msgs.odometry_pb2 import Odometry
        from gz.msgs.pose_v_pb2 import Pose_V
        from gz.msgs.twist_pb2 import Twist

        self._odometry_type, self._pose_v_type = Odometry, Pose_V
        node.subscribe(Twist, self.command_topic, self._on_command)
        node.subscribe(Boolean, self.enable_topic, self._on_enable)
        self._publisher = node.advertise(self.odometry_topic, Odometry)
        self._tf_publisher = node.advertise(self.tf_topic, Pose_V)

    def command(self, linear: float, angular: float) -> bool:
        """Set the wanted forward speed (m/s) and turning speed (rad/s); return False when it was refused.

        Values that are not finite never reach the physics: they are dropped, counted and reported once.
        """
        if not (math.isfinite(linear) and math.isfinite(angular)):
            self._world.drop_command(self.command_topic, f"linear.x={linear}, angular.z={angular}")
            return False
        if self._enabled:
            # Within these bounds no sum of the two overflows; the wheel speed is limited further on.
            self._target = (min(max(linear, -1e9), 1e9), min(max(angular, -1e9), 1e9))
        return self._enabled

    def _on_command(self, message: Any) -> None:
        self.command(message.linear.x, message.angular.z)

    def _on_enable(self, message: Any) -> None:
        self._enabled = bool(message.data)
        if not self._enabled:
            self._target = (0.0, 0.0)

    def pre_update(self, info: UpdateInfo) -> None:
        """Hand the wheel speeds computed after the last step to the servos."""
        speeds = (self._left_speed, self._right_speed)
        if speeds != self._written:
            control = self._world.data.ctrl
            for address in self._left:
                control[address.control] = self._left_speed
            for address in self._right:
                control[address.control] = self._right_speed
            self._written = speeds

    def post_update(self, info: UpdateInfo) -> None:
        """Compute the next wheel speeds, advance the odometry, publish it when due."""
        linear, angular = self._target
        if self._limited:
            last, before = self._last, self._before_last
            linear = self._limit_linear.limit(linear, last[0], before[0], info.dt)
            angular = self._limit_angular.limit(angular, last[1], before[1], info.dt)
            self._before_last = last
            self._last = (linear, angular)
        turn = angular * self._half_separation
        left_speed = (linear - turn) / self._radius
        right_speed = (linear + turn) / self._radius
        if not (
            -MAX_WHEEL_SPEED <= left_speed <= MAX_WHEEL_SPEED and -MAX_WHEEL_SPEED <= right_speed <= MAX_WHEEL_SPEED
        ):
            self._world.diagnostics.warn(
                "",
                f"a command on {self.command_topic} asks for wheels faster than {MAX_WHEEL_SPEED:g} rad/s; "
                "they are held at that speed",
            )
            left_speed = min(max(left_speed, -MAX_WHEEL_SPEED), MAX_WHEEL_SPEED)
            right_speed = min(max(right_speed, -MAX_WHEEL_SPEED), MAX_WHEEL_SPEED)
        self._left_speed = left_speed
        self._right_speed = right_speed
        positions = self._world.data.qpos
        left = positions.item(self._left[0].position)
        right = positions.item(self._right[0].position)
        if not self._started:
            # Gazebo's odometry takes its start from the first step without publishing; its wheels count from
            # zero.
            self._odometry.reset(0.0, 0.0)
            self._started = True
            return
        self._odometry.update(left, right, info.dt)
        if info.sim_time_ns - self._last_published_ns >= self._odometry_period_ns:
            self._last_published_ns = info.sim_time_ns
            self._publish(info.sim_time_ns)

    def _publish(self, now_ns: int) -> None:
        odometry = self._odometry
        if self._publisher is not None and self._publisher.has_connections():
            message = self._odometry_type()
            self._fill_header(message.header, now_ns)
            self._fill_pose(message.pose)
            message.twist.linear.x = odometry.linear
            message.twist.angular.z = odometry.angular
            self._publisher.publish(message)
        if self._tf_publisher is not None and self._tf_publisher.has_connections():
            message = self._pose_v_type()
            pose = message.pose.add()
            self._fill_header(pose.header, now_ns)
            self._fill_pose(pose)
            self._tf_publisher.publish(message)

    def _fill_header(self, header: Any, now_ns: int) -> None:
        header.stamp.sec, header.stamp.nsec = divmod(now_ns, 1_000_000_000)
        for key, value in (("frame_id", self.frame_id), ("child_frame_id", self.child_frame_id)):
            entry = header.data.add()
            entry.key = key
            entry.value.append(value)

    def _fill_pose(self, pose: Any) -> None:
        pose.position.x = self._odometry.x
        pose.position.y = self._odometry.y
        half = self._odometry.heading / 2.0
        pose.orientation.z = math.sin(half)
        pose.orientation.w = math.cos(half)


def _joints(model: Model, plugin: Plugin, side: str) -> list[str]:
    names: list[str] = []
    prefix = f"{plugin.scope}::" if plugin.scope else ""
    for element in plugin.element.all(side):
        name = prefix + element.text
        joint = model.joint(name)
        if joint is None:
            known = [each.name.removeprefix(prefix) for each in model.joints]
            raise element.error(
                f"DiffDrive's <{side}> names joint '{element.text}', which model '{model.name}' does not "
                "have; "
                f"{nearest(element.text, known, listing='its joints are')}"
            )
        if joint.kind not in ("revolute", "continuous"):
            raise element.error(
                f"DiffDrive's <{side}> '{element.text}' is a {joint.kind} joint; a wheel needs a revolute one"
            )
        names.append(name)
    if not names:
        raise plugin.element.error(f"DiffDrive needs at least one <{side}>, none was found")
    return names


def _skids(model: Model, side: list[str], radius: float) -> bool:
    """Tell whether wheels of one side stand one behind the other, not on one axle."""
    places: list[Vector] = []
    axles: list[Vector] = []
    for name in side:
        joint = model.joint(name)
        link = model.link(joint.child) if joint is not None else None
        if joint is None or link is None or joint.axis is None:
            continue
        places.append((link.pose * joint.pose).position)
        axles.append(rotate(link.pose.quaternion, np.array(joint.axis.direction)))
    return any(
        float(np.linalg.norm(np.cross(place - places[0], axle))) > 0.1 * radius
        for place, axle in zip(places, axles, strict=True)
    )


def _positive(element: Element, tag: str, default: float) -> float:
    value = element.number(tag, default)
    if not 0.0 < value < math.inf:
        raise element.error(f"DiffDrive's <{tag}> must be greater than zero, got {value}")
    return value
