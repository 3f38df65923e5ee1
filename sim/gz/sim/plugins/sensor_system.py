"""The base class of systems that run sensors: it creates, schedules and updates them.

`Sensors`, `Imu` and similar plugins of the world update, after each physics step, the sensors that are due and have a
subscriber. The file of a sensor type declares the plugin that runs it with `sensor_system`.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.plugins.sensor import SensorBase, sensor_types
from gz_course.sim.gz.sim.plugins.system import FOREVER_NS, System, UpdateInfo, system
from gz_course.sim.gz.sim.sdf.description import Model, Plugin, Sensor

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node


class SensorSystem(System):
    """Creates and schedules every sensor of the world whose class has `runs_in` = this system's name."""

    once = True

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        self._world = world
        self.sensors: list[SensorBase] = []
        self._nodes: dict[int, Node] = {}
        self._node: Node | None = None
        self._next_ns = 0

    def bind(self) -> None:
        """Create the sensors of new models, drop those of removed models, and bind all of them to MuJoCo's model.

        A sensor that cannot be created is left out with a warning.
        """
        types = sensor_types()
        made = {id(sensor.description): sensor for sensor in self.sensors}
        wanted: list[SensorBase] = []
        new: set[SensorBase] = set()
        for model in self._world.description.models:
            for description in model.sensors():
                found = types.get(description.kind)
                if found is None or found.runs_in != self.name:
                    continue
                sensor = made.pop(id(description), None)
                if sensor is None:
                    sensor = self._make(found, description)
                    if sensor is None:
                        continue
                    sensor.rescheduled = self._reschedule  # type: ignore[method-assign]
                    new.add(sensor)
                wanted.append(sensor)
        for gone in made.values():
            node = self._nodes.pop(id(gone), None)
            if node is not None:
                node.close()
        self.sensors = wanted
        for sensor in wanted:
            sensor.bind()
            if sensor in new:
                sensor.start()
                self._open(sensor)
        self._next_ns = 0

    def _make(self, found: type[SensorBase], description: Sensor) -> SensorBase | None:
        """Return a sensor, or None after a warning; as in Gazebo the rest of the world runs on."""
        try:
            return found(self._world, description)
        except SdfError as error:
            text = f"{error}; sensor '{description.name}' of model '{description.model}' stays silent"
            self._world.diagnostics.warn("", text)
            return None

    def start(self) -> None:
        self._next_ns = 0
        for sensor in self.sensors:
            sensor.start()

    def connect(self, node: Node) -> None:
        """Let every sensor advertise on a node of its own."""
        self._node = node
        for sensor in self.sensors:
            self._open(sensor)

    def connected(self) -> Iterator[tuple[SensorBase, Node]]:
        """Yield the connected sensors, each with its own node."""
        return ((sensor, self._nodes[id(sensor)]) for sensor in self.sensors if id(sensor) in self._nodes)

    def close(self) -> None:
        for node in self._nodes.values():
            node.close()
        self._nodes.clear()

    def _open(self, sensor: SensorBase) -> None:
        if self._node is not None and id(sensor) not in self._nodes:
            own = self._nodes[id(sensor)] = type(self._node)(self._node.options)
            sensor.connect(own)
            sensor.offer_set_rate(own)

    def _reschedule(self) -> None:
        self._next_ns = 0

    def post_update(self, info: UpdateInfo) -> None:
        now = info.sim_time_ns
        if now < self._next_ns:
            return
        following = FOREVER_NS
        for sensor in self.sensors:
            if now >= sensor.next_update_ns:
                sensor.run(now)
            following = min(following, sensor.next_update_ns)
        self._next_ns = following

    def rests_until(self, info: UpdateInfo) -> int:
        return self._next_ns


def sensor_system(name: str, filename: str) -> str:
    """Register a plugin that runs sensors and has no parameters; return its name, for `SensorBase.runs_in`."""
    system(name, filename)(type(name, (SensorSystem,), {}))
    return name
