"""Magnetometer: runs the magnetometers of the world; a plugin of the world.

What is common to all systems that run sensors is in `gz.sim.systems.sensor_system`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from gz_course.sim.gz.sim.sdf.description import Model, Plugin
from gz_course.sim.gz.sim.sensors.magnetometer import Magnetometer as MagnetometerSensor
from gz_course.sim.gz.sim.systems.registry import system
from gz_course.sim.gz.sim.systems.sensor_system import SensorSystem

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.world import World


@system("Magnetometer", "gz-sim-magnetometer-system")
class Magnetometer(SensorSystem):
    """Runs every sensor of type magnetometer. `<use_units_gauss>` and `<use_earth_frame_ned>` (both true unless said
    otherwise) tell how the earth's field is expressed.
    """

    parameters = frozenset(("use_units_gauss", "use_earth_frame_ned"))

    def configure(self, world: World, model: Model | None, plugin: Plugin) -> None:
        """Read how the earth's field is expressed."""
        super().configure(world, model, plugin)
        self._gauss = plugin.element.flag("use_units_gauss", True)
        self._ned = plugin.element.flag("use_earth_frame_ned", True)

    def bind(self) -> None:
        """Make and place the sensors, and tell them."""
        super().bind()
        for sensor in self.sensors:
            if isinstance(sensor, MagnetometerSensor):
                sensor.use_units_gauss, sensor.use_earth_frame_ned = self._gauss, self._ned
