"""LinearBatteryPlugin: a battery whose voltage falls linearly with its charge; a plugin of a model.

It is drained by `<power_load>` [W] as soon as a joint of the model is driven, and publishes `gz.msgs.BatteryState` on
`/model/M/battery/NAME/state` at 50 Hz of simulated time: voltage [V], current [A], charge and capacity [Ah]. A battery
that is empty does not stop the robot, as in Gazebo.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/battery_plugin/LinearBatteryPlugin.cc
"""

from __future__ import annotations

import math
from collections import deque
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from gz_course.sim.gz.sim.plugins.model_scope import ModelScope
from gz_course.sim.gz.sim.plugins.system import System, UpdateInfo, system
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.sim.requests import logged
from gz_course.sim.gz.sim.sdf.description import Model, Plugin
from gz_course.sim.gz.sim.sdf.element import Element

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node

_PERIOD_NS = 20_000_000
_SUMMED_STEPS = 100
_CHARGED = 0.9  # state of charge at which charging ends and a resting battery counts as full
_LEAST_VOLTAGE = 1e-3
_HOUR = 3600.0


@system("LinearBatteryPlugin", "gz-sim-linearbatteryplugin-system")
class LinearBatteryPlugin(System):
    """The parameters are those of Gazebo.

    Without `<fix_issue_225>` the state of charge falls a hundred times too fast, as in Gazebo.
    """

    parameters = frozenset(
        (
            "battery_name",
            "voltage",
            "open_circuit_voltage_constant_coef",
            "open_circuit_voltage_linear_coef",
            "initial_charge",
            "capacity",
            "resistance",
            "smooth_current_tau",
            "fix_issue_225",
            "invert_current_sign",
            "enable_recharge",
            "charging_time",
            "recharge_by_topic",
            "power_load",
            "start_draining",
            "power_draining_topic",
            "stop_power_draining_topic",
        )
    )

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        """Read the parameters. Raises SdfError without name, voltage or capacity."""
        element = plugin.element
        self._world = world
        self.scope = ModelScope(world, model, plugin, self.name)
        self.battery = element.text_of("battery_name")
        if not self.battery:
            raise element.error("LinearBatteryPlugin needs a <battery_name>, none was found")
        self._full_voltage = _positive(element, "voltage")
        self._capacity = _positive(element, "capacity")
        self._constant = element.number("open_circuit_voltage_constant_coef", 0.0)
        self._linear = element.number("open_circuit_voltage_linear_coef", 0.0)
        self._initial = min(max(element.number("initial_charge", 0.0), 0.0), self._capacity)
        self._resistance = element.number("resistance", 0.0)
        self._tau = _positive(element, "smooth_current_tau", 1.0)
        self._right = element.flag("fix_issue_225", False)
        self._sign = -1.0 if element.flag("invert_current_sign", False) else 1.0
        self._load = element.number("power_load", 0.0)
        self.loads: dict[object, float] = {}
        """The power [W] that each other system of the world draws from this battery."""
        self._drains_at_start = element.flag("start_draining", False)
        self._starting = [child.text for child in element.all("power_draining_topic")]
        self._stopping = [child.text for child in element.all("stop_power_draining_topic")]
        self._rechargeable = element.flag("enable_recharge", False)
        self._by_topic = element.find("recharge_by_topic") is not None
        self._charging_hours = _positive(element, "charging_time") if self._rechargeable else math.inf
        self.topic = valid_topic(f"/model/{self.scope.name}/battery/{self.battery}")
        self._publisher: Any = None

    def bind(self) -> None:
        model, prefix = self._world.model, f"{self.scope.model.name}::"
        names = (mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_ACTUATOR, number) for number in range(model.nu))
        self._controls = np.array([number for number, name in enumerate(names) if name.startswith(prefix)], dtype=int)

    def start(self) -> None:
        self._draining, self._charging = self._drains_at_start, False
        self._charge, self._voltage = self._initial, self._full_voltage
        self.state_of_charge = self._initial / self._capacity
        """The fraction of the capacity that Gazebo reports."""
        self._current = 0.0
        self._currents: deque[float] = deque(maxlen=_SUMMED_STEPS)
        self._published_ns = -_PERIOD_NS

    def connect(self, node: Node) -> None:
        from gz_course.sim.gz.msgs.battery_state_pb2 import BatteryState
        from gz_course.sim.gz.msgs.boolean_pb2 import Boolean
        from gz_course.sim.gz.msgs.empty_pb2 import Empty

        self._type = BatteryState
        self._publisher = node.advertise(f"{self.topic}/state", BatteryState)
        for topics, on in ((self._starting, True), (self._stopping, False)):
            for topic in topics:
                node.subscribe_raw(topic, lambda *_, on=on, topic=topic: self._request("_draining", on, topic))
        for word, on in (("start", True), ("stop", False)) if self._rechargeable else ():
            place = f"{self.topic}/recharge/{word}"

            def serve(_: Any, on: bool = on, place: str = place) -> Empty:
                self._request("_charging", on, place)
                return Empty()

            node.advertise_service(place, Boolean, Empty, serve)
            if self._by_topic:
                node.subscribe(Boolean, place, serve)

    def _request(self, what: str, on: bool, place: str) -> None:
        self._world.requests.put(logged(lambda: setattr(self, what, on), place))

    def post_update(self, info: UpdateInfo) -> None:
        """Drain or charge the battery for one step, and publish when it is due."""
        self._draining = self._draining or bool(self._world.data.ctrl[self._controls].any())
        if self._draining or self._charging:
            self._update(info.dt)
        if info.sim_time_ns - self._published_ns >= _PERIOD_NS:
            self._published_ns = info.sim_time_ns
            if self._publisher is not None and self._publisher.has_connections():
                self._publish(info.sim_time_ns)

    def _update(self, dt: float) -> None:
        if not self._charging and (self._voltage < _LEAST_VOLTAGE or self.state_of_charge < 0.0):
            return
        load = self._load + sum(self.loads.values())
        drawn = load / max(self._voltage, _LEAST_VOLTAGE) if self._draining else 0.0
        if self._charging and self.state_of_charge < _CHARGED:
            drawn -= self._capacity / self._charging_hours
        self._current += dt / max(self._tau, dt) * (drawn - self._current)
        self._charge -= dt * self._current / _HOUR
        used = 1.0 - self._charge / self._capacity
        self._voltage = max(0.0, self._constant + self._linear * used - self._resistance * self._current)
        if self._right:
            self.state_of_charge = self._charge / self._capacity
        else:
            self._currents.append(self._current * dt / _HOUR)
            self.state_of_charge -= sum(self._currents) / self._capacity

    def _publish(self, now_ns: int) -> None:
        message = self._type(
            voltage=self._voltage,
            current=self._sign * self._current,
            charge=self._charge,
            capacity=self._capacity,
            percentage=self.state_of_charge * (100.0 if self._right else 1.0),
            power_supply_status=self._status(),
        )
        message.header.stamp.sec, message.header.stamp.nsec = divmod(now_ns, 1_000_000_000)
        self._publisher.publish(message)

    def _status(self) -> str:
        if self._charging:
            return "CHARGING"
        if self._draining:
            return "DISCHARGING"
        return "FULL" if self.state_of_charge > _CHARGED else "NOT_CHARGING"


def _positive(element: Element, tag: str, default: float = 0.0) -> float:
    value = element.number(tag, default)
    if not 0.0 < value < math.inf:
        raise element.error(f"LinearBatteryPlugin needs a <{tag}> greater than zero, got {value:g}")
    return value
