"""Thruster: a propeller of a boat or an underwater vehicle, which pushes along the axis of its joint.

A thrust [N] as `gz.msgs.Double` on `/model/NAMESPACE/joint/JOINT/cmd_thrust` acts on the link of the propeller at its
origin, along the axis of the joint, and holds until the next command. The propeller turns with the speed n [rad/s]
that belongs to it: thrust = density * coefficient * diameter^4 * n * |n|. With `<use_angvel_cmd>` the command is that
speed, on `.../cmd_vel`. The speed is reached with a PID controller of the torque, or exactly with
`<velocity_control>`; it is published on `.../ang_vel`, in the other mode the thrust on `.../force`. Thrusts below
`<deadband>` count as none.

Without `<thrust_coefficient>` it is alpha_1 + alpha_2 * (1 - wake_fraction) * v / (n * diameter) at the speed v [m/s]
of the propeller. A thruster stops when a battery of its model is empty, and draws `<power_load>` [W] from the one
called `<battery_name>`.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/thruster/Thruster.cc; T. Fossen, Guidance and
Control of Ocean Vehicles, 1994, p. 246
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.driving.pid import PID
from gz_course.sim.gz.sim.physics.pushes import push, refresh_velocities, velocity
from gz_course.sim.gz.sim.physics.servos import VELOCITY, JointServo, find_drive
from gz_course.sim.gz.sim.plugins.model_scope import ModelScope
from gz_course.sim.gz.sim.plugins.system import System, UpdateInfo, system
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.sim.pose import rotate
from gz_course.sim.gz.sim.sdf.description import Joint, Model, Plugin
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.systems.linear_battery_plugin import LinearBatteryPlugin

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node

_MOST = 1000.0
_CLOSE = 0.1
"""Error of the speed [rad/s] up to which the controller is silent."""


@system("Thruster", "gz-sim-thruster-system")
class Thruster(System):
    """One propeller; several of a model have a plugin each. Parameters and defaults are Gazebo's."""

    pushes = True
    parameters = frozenset(
        (
            *("namespace", "topic", "joint_name", "use_angvel_cmd", "velocity_control", "deadband"),
            *("fluid_density", "propeller_diameter", "thrust_coefficient", "wake_fraction", "alpha_1", "alpha_2"),
            *("p_gain", "i_gain", "d_gain", "max_thrust_cmd", "min_thrust_cmd", "battery_name", "power_load"),
        )
    )

    @classmethod
    def servos(cls, model: Model, plugin: Plugin) -> list[JointServo]:
        """Request a velocity servo with `<velocity_control>`. Raises SdfError for a joint that does not exist."""
        joint = _joint(model, plugin)
        return [JointServo(joint.name, VELOCITY)] if plugin.element.flag("velocity_control", False) else []

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        self.scope = scope = ModelScope(world, model, plugin, self.name)
        self.world, self._element = world, plugin.element
        element = plugin.element
        self.joint = _joint(scope.model, plugin)
        self._by_speed = element.flag("use_angvel_cmd", False)
        self._servoed = element.flag("velocity_control", False)
        self._stated = element.find("thrust_coefficient") is not None
        self._coefficient = element.number("thrust_coefficient", 1.0)
        self._alphas = element.number("alpha_1", 1.0), element.number("alpha_2", 0.0)
        self._wake = element.number("wake_fraction", 0.2)
        self._diameter = _positive(element, "propeller_diameter", 0.02)
        self._density = _positive(element, "fluid_density", 1000.0)
        numbers = (self._coefficient, *self._alphas, self._wake)
        if self._coefficient == 0.0 or not all(map(math.isfinite, numbers)):
            raise element.error("Thruster's coefficients must be finite, and <thrust_coefficient> not zero")
        self._deadband = element.number("deadband", 0.0)
        self._deadband_on = element.find("deadband") is not None
        self._limits = element.number("min_thrust_cmd", -_MOST), element.number("max_thrust_cmd", _MOST)
        if self._limits[1] < self._limits[0]:
            text = "Thruster's <max_thrust_cmd> is below its <min_thrust_cmd>; the limits are -1000 and 1000"
            world.diagnostics.warn(element.where, text)
            self._limits = -_MOST, _MOST
        self._find_topics(element)
        self.thrust = self.speed = self._way = 0.0
        low, high = (self._speed_for(limit) for limit in self._limits)
        self._pid = PID.from_sdf(element, 0.1, 0.0, 0.0, 1.0, -1.0, high, low, 0.0)

    def _find_topics(self, element: Element) -> None:
        space = element.text_of("namespace", self.scope.name)
        own = element.text_of("topic")
        joint = self.scope.own_name(self.joint.name)
        stem = f"/{space}/{valid_topic(own).strip('/')}" if own else f"/model/{space}/joint/{joint}"
        command = "" if own else "/cmd_vel" if self._by_speed else "/cmd_thrust"
        self.topic = valid_topic(stem + command)
        self.feedback_topic = valid_topic(stem + ("/force" if self._by_speed else "/ang_vel"))
        self.deadband_topic = valid_topic(f"{stem}/enable_deadband")
        self._publisher: Any = None

    def bind(self) -> None:
        self._body = self.scope.body(self.joint.child)
        model = self.world.model
        servo = JointServo(self.joint.name, VELOCITY)
        self._drive = find_drive(model, self.scope.model, servo) if self._servoed else None
        dof = int(model.body_dofadr[self._body]) if self._body > 0 and model.body_dofnum[self._body] else -1
        self._inertia = 1.0 / max(float(model.dof_invweight0[dof]), 1e-12) if dof >= 0 else math.inf
        batteries = [each for each in self.world.systems if isinstance(each, LinearBatteryPlugin)]
        self._batteries = [each for each in batteries if each.scope.full_name == self.scope.full_name]
        wanted, load = self._element.text_of("battery_name"), self._element.number("power_load", 0.0)
        named = [each for each in self._batteries if each.battery == wanted]
        for battery in named:
            battery.loads[self] = load
        if wanted and not named:
            hint = did_you_mean(wanted, [each.battery for each in self._batteries], listing="its batteries are")
            text = f"Thruster's <battery_name> '{wanted}' is not a battery of model '{self.scope.full_name}'{hint}"
            self.world.diagnostics.warn(self._element.where, text)

    def start(self) -> None:
        self.thrust = self.speed = self._way = 0.0
        self._pid.reset()

    def connect(self, node: Node) -> None:
        from gz_course.sim.gz.msgs.boolean_pb2 import Boolean
        from gz_course.sim.gz.msgs.double_pb2 import Double

        self._type = Double
        self._publisher = node.advertise(self.feedback_topic, Double)
        node.subscribe(Double, self.topic, lambda message: self.command(message.data))
        node.subscribe(Boolean, self.deadband_topic, lambda message: setattr(self, "_deadband_on", message.data))

    def command(self, value: float) -> None:
        """Set the thrust [N], or with `<use_angvel_cmd>` the speed of the propeller [rad/s]."""
        if not math.isfinite(value):
            self.world.drop_command(self.topic, f"data={value}")
            return
        value = min(max(value, self._limits[0]), self._limits[1])
        self.thrust = self._strength() * abs(value) * value if self._by_speed else value
        if self._by_speed:
            self.speed = value

    def _strength(self) -> float:
        """Return thrust / (n |n|) [N s^2]."""
        return self._density * self._coefficient * self._diameter**4

    def _speed_for(self, thrust: float) -> float:
        """Return the speed [rad/s] that belongs to a thrust [N], at the present way through the water."""
        if not self._stated and abs(self.speed) > 1e-15:
            advance = (1.0 - self._wake) * self._way / (self.speed * self._diameter)
            self._coefficient = self._alphas[0] + self._alphas[1] * advance or 1e-12
        ratio = thrust / self._strength()
        return math.copysign(math.sqrt(abs(ratio)), ratio)

    def pre_update(self, info: UpdateInfo) -> None:
        if any(battery.state_of_charge <= 0.0 for battery in self._batteries) or self._body <= 0:
            return
        data = self.world.data
        thrust = self.thrust
        speed = self.speed = self._speed_for(thrust)
        if self._deadband_on and abs(thrust) < self._deadband:
            thrust = speed = 0.0
        refresh_velocities(self.world)
        assert self.joint.axis is not None
        axis = rotate(data.xquat[self._body], np.array(self.joint.axis.direction))
        linear, angular = velocity(self.world, self._body)
        turning, torque = float(angular @ axis), 0.0
        if self._drive is not None:
            self._drive.hold(data, speed, info.dt)
            turning = speed
        elif abs(turning - speed) > _CLOSE:
            torque = self._pid.update(turning - speed, info.dt)
            # A stronger torque would carry the propeller beyond its speed within one step.
            most = abs(turning - speed) * self._inertia / info.dt
            torque = min(max(torque, -most), most)
        push(data, self._body, thrust * axis, data.xpos[self._body], torque * axis)
        self._way = float(np.linalg.norm(linear))
        if self._publisher is not None and self._publisher.has_connections():
            self._publisher.publish(self._type(data=thrust if self._by_speed else turning))


def _joint(model: Model, plugin: Plugin) -> Joint:
    element = plugin.element
    prefix = f"{plugin.scope}::" if plugin.scope else ""
    name = element.text_of("joint_name")
    if not name:
        raise element.error("Thruster needs a <joint_name>, none was found")
    joint = model.joint(prefix + name)
    if joint is None:
        hint = did_you_mean(name, [each.name.removeprefix(prefix) for each in model.joints], listing="its joints are")
        raise element.error(f"Thruster names joint '{name}', which model '{model.name}' does not have{hint}")
    if joint.axis is None:
        raise element.error(f"Thruster's joint '{name}' is a {joint.kind} joint; a propeller needs one with an axis")
    return joint


def _positive(element: Element, tag: str, default: float) -> float:
    value = element.number(tag, default)
    if not 0.0 < value < math.inf:
        raise element.error(f"Thruster's <{tag}> must be greater than zero, got {value:g}")
    return value
