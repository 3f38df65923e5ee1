"""DiffDrive: converts velocity commands to wheel speeds, and wheel angles to odometry.

`Twist` on `/model/M/cmd_vel` -> target -> limits -> wheel speeds -> MuJoCo servos; after each step wheel angles ->
odometry on `/model/M/odometry` and `/model/M/tf`. As in Gazebo a command takes effect one step after it is received,
holds without a timeout, and only `linear.x` and `angular.z` are used.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/diff_drive/DiffDrive.cc
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.driving.odometry_reports import OdometryReports
from gz_course.sim.gz.sim.driving.speed_limiter import SpeedLimiter, limit_parameters
from gz_course.sim.gz.sim.driving.tyre_slip import TyreSlip
from gz_course.sim.gz.sim.driving.wheel_odometry import WheelOdometry
from gz_course.sim.gz.sim.physics.servos import MAX_WHEEL_SPEED, WHEEL, JointServo
from gz_course.sim.gz.sim.plugins.model_scope import ModelScope
from gz_course.sim.gz.sim.plugins.system import System, UpdateInfo, system
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.sim.pose import Vector, rotate
from gz_course.sim.gz.sim.sdf.description import Model, Plugin
from gz_course.sim.gz.sim.sdf.element import Element

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node


_MOST_FASTER = 0.02  # turning in Gazebo, relative to that here, that is not worth a warning


@system("DiffDrive", "gz-sim-diff-drive-system")
class DiffDrive(System):
    """Drives one model with wheels on its left and right side. Parameters and defaults are Gazebo's."""

    parameters = frozenset(
        [
            *limit_parameters("linear", "angular"),
            "left_joint",
            "right_joint",
            "wheel_separation",
            "wheel_radius",
            "topic",
            *OdometryReports.parameters,
        ]
    )

    @classmethod
    def servos(cls, model: Model, plugin: Plugin) -> list[JointServo]:
        """Request a velocity servo for every wheel joint. Raises SdfError for a joint that does not exist."""
        left, right = (_joints(model, plugin, side) for side in ("left_joint", "right_joint"))
        radius = _positive(plugin.element, "wheel_radius", 0.2)
        wheels = left + right
        skids = any(_skids(model, side, radius) for side in (left, right)) and len(set(_frictions(model, wheels))) == 1
        return [JointServo(joint, WHEEL, radius, len(wheels), skids=skids) for joint in wheels]

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
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
        name = scope.name
        self.command_topic = valid_topic(element.text_of("topic"), f"/model/{name}/cmd_vel")
        self.enable_topic = valid_topic(f"/model/{name}/enable")
        self._reports = OdometryReports(scope, element)
        self._model = model
        self._sides = [_joints(model, plugin, side) for side in ("left_joint", "right_joint")]
        both = sorted(set(self._sides[0]) & set(self._sides[1]))
        if both:
            text = f"DiffDrive of model '{scope.full_name}' has joint '{both[0]}' on the left and on the right; "
            world.diagnostics.warn(element.where, f"{text}name another joint in one of them")
        if any(_skids(model, side, radius) for side in self._sides):
            self._check_grip(scope, element)
        else:
            self._check_width(scope, element, separation)
        self._most, self._slowest = min(_limit(model, name) for side in self._sides for name in side)
        self._odometry = WheelOdometry(separation, radius)
        self._slip = TyreSlip(world, model)
        self.pushes = self._slip.active  # type: ignore[misc]

    def _check_grip(self, scope: ModelScope, element: Element) -> None:
        """Warn about a robot that must skid to turn, which it does not in Gazebo."""
        if _grips(self._model, self._sides):
            text = f"the wheels of model '{scope.full_name}' grip sideways, so it turns here, but hardly in Gazebo; "
            text += "give their collisions <slip1>0.035</slip1> and <fdir1>0 0 1</fdir1> in <surface><friction><ode>"
            self._world.diagnostics.differs(element.where, text)

    def _check_width(self, scope: ModelScope, element: Element, separation: float) -> None:
        """Warn about wide cylinders as wheels, with which a robot turns faster in Gazebo."""
        width = min(_width(self._model, side) for side in self._sides)
        faster = width / (separation - width) if width < separation else 0.0
        if faster > _MOST_FASTER:
            text = f"the wheels of model '{scope.full_name}' are cylinders, {width:g} m wide; in Gazebo they touch the "
            text += f"ground at their edges, so that it turns {faster:.0%} faster there; make their collisions "
            text += "<sphere>, or cylinders of <length>0.001</length>"
            self._world.diagnostics.differs(element.where, text)

    @property
    def reports(self) -> OdometryReports:
        return self._reports

    def bind(self) -> None:
        self._slip.bind()
        self._left, self._right = (
            [self._world.truth.joint_address(self._model, joint) for joint in side] for side in self._sides
        )

    def start(self) -> None:
        self._started = False
        self._reports.start()
        self._target = (0.0, 0.0)
        self._heeded = (0.0, 0.0)
        self._last = (0.0, 0.0)
        self._before_last = (0.0, 0.0)
        self._settled = False
        self._left_speed = self._right_speed = 0.0
        self._written: tuple[float, float] | None = None
        self._enabled = True

    def connect(self, node: Node) -> None:
        from gz_course.sim.gz.msgs.boolean_pb2 import Boolean
        from gz_course.sim.gz.msgs.twist_pb2 import Twist

        node.subscribe(Twist, self.command_topic, self._on_command)
        node.subscribe(Boolean, self.enable_topic, self._on_enable)
        self._reports.connect(node)

    def command(self, linear: float, angular: float) -> bool:
        """Set the commanded forward speed [m/s] and yaw rate [rad/s]; return False if they are refused.

        Values that are not finite are dropped, counted and reported once.
        """
        if not (math.isfinite(linear) and math.isfinite(angular)):
            self._world.drop_command(self.command_topic, f"linear.x={linear}, angular.z={angular}")
            return False
        if self._enabled:
            # Within these bounds no sum of the two overflows; the wheel speed is limited later.
            self._target = (min(max(linear, -1e9), 1e9), min(max(angular, -1e9), 1e9))
        return self._enabled

    def _on_command(self, message: Any) -> None:
        self.command(message.linear.x, message.angular.z)

    def _on_enable(self, message: Any) -> None:
        self._enabled = bool(message.data)
        if not self._enabled:
            self._target = (0.0, 0.0)

    def pre_update(self, info: UpdateInfo) -> None:
        """Write the wheel speeds computed after the last step to the servos; push tyres that slip."""
        if self.pushes:
            self._slip.push()
        speeds = (self._left_speed, self._right_speed)
        if speeds != self._written:
            control = self._world.data.ctrl
            for address in self._left:
                control[address.control] = self._left_speed
            for address in self._right:
                control[address.control] = self._right_speed
            self._written = speeds

    def sampler(self) -> Callable[[], None]:
        """Return a function that stores the wheel angles for the odometry."""
        item, store = self._world.data.qpos.item, self._odometry.waiting.append
        left, right = self._left[0].position, self._right[0].position
        dt = self._world.step_size_ns * 1e-9
        return lambda: store((item(left), item(right), dt))

    def rests_until(self, info: UpdateInfo) -> int:
        if self._target is not self._heeded or not self._settled or self._odometry.is_full:
            return 0
        return self._reports.next_ns if (self._left_speed, self._right_speed) == self._written else 0

    def post_update(self, info: UpdateInfo) -> None:
        """Compute the next wheel speeds; publish the odometry when due."""
        target = self._target
        if not self._settled or target is not self._heeded:  # most steps have no new command
            self._heeded = target
            self._find_speeds(info.dt)
        if not self._started:
            # Gazebo's odometry takes its start from the first step without publishing; its wheels count from
            # zero.
            self._odometry.reset(0.0, 0.0)
            self._started = True
            return
        if self._reports.due(info.sim_time_ns):
            if self._reports.has_connections():
                odometry = self._odometry
                pose = (odometry.x, odometry.y, odometry.heading)
                self._reports.publish(info.sim_time_ns, pose, odometry.linear, odometry.angular)
        elif self._odometry.is_full:
            self._odometry.catch_up()

    def _find_speeds(self, dt: float) -> None:
        """Limit the target and convert it to wheel speeds."""
        linear, angular = self._heeded
        self._settled = True
        if self._limited:
            last, before = self._last, self._before_last
            linear = self._limit_linear.limit(linear, last[0], before[0], dt)
            angular = self._limit_angular.limit(angular, last[1], before[1], dt)
            self._before_last = last
            self._last = (linear, angular)
            self._settled = self._last == last == before  # then the next step finds the same
        turn = angular * self._half_separation
        left_speed = (linear - turn) / self._radius
        right_speed = (linear + turn) / self._radius
        asked = max(abs(left_speed), abs(right_speed))
        if asked > self._most > 0.0:
            self._world.diagnostics.warn_once(
                f"{self.command_topic} {self._slowest}",
                "",
                f"a command on {self.command_topic} asks for {asked:.3g} rad/s of a wheel, but joint "
                f"'{self._slowest}' has the limit velocity {self._most:g} rad/s; the wheels turn no faster",
            )
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


def _joints(model: Model, plugin: Plugin, side: str) -> list[str]:
    names: list[str] = []
    prefix = f"{plugin.scope}::" if plugin.scope else ""
    for element in plugin.element.all(side):
        name = prefix + element.text
        joint = model.joint(name)
        if joint is None:
            known = [each.name.removeprefix(prefix) for each in model.joints]
            raise element.error(
                f"DiffDrive's <{side}> names joint '{element.text}', which model '{model.name}' does not have"
                f"{did_you_mean(element.text, known, listing='its joints are')}"
            )
        if joint.kind not in ("revolute", "continuous"):
            raise element.error(
                f"DiffDrive's <{side}> '{element.text}' is a {joint.kind} joint; a wheel needs a revolute one"
            )
        names.append(name)
    if not names:
        raise plugin.element.error(f"DiffDrive needs at least one <{side}>, none was found")
    return names


def _limit(model: Model, name: str) -> tuple[float, str]:
    """Return the largest velocity [rad/s] of a wheel's joint, and its name."""
    joint = model.joint(name)
    return (math.inf if joint is None or joint.axis is None else joint.axis.velocity), name


def _skids(model: Model, side: list[str], radius: float) -> bool:
    """Tell whether the wheels of one side are behind each other instead of on one axle."""
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


def _width(model: Model, side: list[str]) -> float:
    """Return the width [m] of the widest cylinder of the wheels of one side; 0 if there is none."""
    joints = (model.joint(name) for name in side)
    links = (model.link(joint.child) for joint in joints if joint is not None)
    parts = (part for link in links if link is not None for part in link.collisions)
    return max((part.geometry.size[2] for part in parts if part.geometry.kind == "cylinder"), default=0.0)


def _frictions(model: Model, wheels: list[str]) -> Iterator[float]:
    """Yield the friction of each collision of the wheels."""
    for joint in (model.joint(name) for name in wheels):
        link = model.link(joint.child) if joint is not None else None
        for part in link.collisions if link is not None else ():
            yield part.mu


def _grips(model: Model, sides: list[list[str]]) -> bool:
    """Tell whether no wheel has a slip, or another friction along its axle."""
    for joint in (model.joint(name) for side in sides for name in side):
        link = model.link(joint.child) if joint is not None else None
        for part in link.collisions if link is not None else ():
            ode = part.element.find("surface/friction/ode")
            if ode is None:
                continue
            mu = ode.number("mu", 1.0)
            if ode.number("mu2", mu) != mu or ode.number("slip1", 0.0) > 0.0 or ode.number("slip2", 0.0) > 0.0:
                return False
    return True


def _positive(element: Element, tag: str, default: float) -> float:
    value = element.number(tag, default)
    if not 0.0 < value < math.inf:
        raise element.error(f"DiffDrive's <{tag}> must be greater than zero, got {value}")
    return value
