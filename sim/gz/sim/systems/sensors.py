"""Sensors: runs the sensors that look at the world (lidars) at their rates, and only those somebody listens
to.

A plugin of the world. After each physics step it asks which sensors are due; a due sensor without listeners
costs one look.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from gz.sim.errors import nearest
from gz.sim.sdf.description import Model, Plugin
from gz.sim.sensors.registry import KNOWN_TYPES, SensorBase, sensor_types
from gz.sim.systems.registry import System, UpdateInfo, system

if TYPE_CHECKING:
    from gz.sim.world import World
    from gz.transport import Node


@system("Sensors", "gz-sim-sensors-system")
class Sensors(System):
    """Creates and schedules every rendering sensor of the world."""

    parameters = frozenset(
        (
            "render_engine",
            "background_color",
            "ambient_light",
            "disable_on_drained_battery",
            "render_engine_api_backend",
        )
    )

    def configure(self, world: World, model: Model | None, plugin: Plugin) -> None:
        """Create the sensors; warn about types nothing here can do."""
        types = sensor_types()
        self.sensors: list[SensorBase] = []
        for each in world.description.models:
            for link in each.links:
                for description in link.sensors:
                    kind = description.kind
                    if kind in types and types[kind].rendering:
                        self.sensors.append(types[kind](world, description))
                    elif kind not in KNOWN_TYPES:
                        hint = nearest(kind, types, listing="types that run here are")
                        text = f"sensor '{description.name}' has type '{kind}', which is not known; {hint}"
                        world.diagnostics.warn(description.element.where, text)
                    elif kind not in types:
                        text = f"sensor type '{kind}' is not simulated here, sensor '{description.name}' stays silent"
                        world.diagnostics.warn(description.element.where, text)
        self._next_ns = 0

    def connect(self, node: Node) -> None:
        """Let every sensor advertise."""
        for sensor in self.sensors:
            sensor.connect(node)

    def post_update(self, info: UpdateInfo) -> None:
        """Update the sensors that are due."""
        now = info.sim_time_ns
        if now < self._next_ns:
            return
        for sensor in self.sensors:
            if now >= sensor.next_update_ns:
                if sensor.has_connections():
                    sensor.update(now)
                sensor.updates += 1
                sensor.next_update_ns += sensor.period_ns
        self._next_ns = min((sensor.next_update_ns for sensor in self.sensors), default=1 << 62)
