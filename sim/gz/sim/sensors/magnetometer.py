"""Magnetometer: the magnetic field along the sensor's own axes, as `gz.msgs.Magnetometer`.

The Magnetometer system runs it. Without `<spherical_coordinates>` the field is the `<magnetic_field>` of the world [T].
Otherwise it is the earth's field at that place; like Gazebo, the system then writes gauss into `field_tesla` and takes
north, east, down as the world's x, y, z, unless its parameters say otherwise.

Source: https://github.com/gazebosim/gz-sensors/blob/gz-sensors8/src/MagnetometerSensor.cc
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from gz_course.sim.gz.sim.magnetic_field import earth_field
from gz_course.sim.gz.sim.plugins.noise import Noise
from gz_course.sim.gz.sim.plugins.sensor import sensor_type
from gz_course.sim.gz.sim.plugins.sensor_system import SensorSystem
from gz_course.sim.gz.sim.plugins.site_sensor import SiteSensor, noise_at
from gz_course.sim.gz.sim.plugins.system import system
from gz_course.sim.gz.sim.pose import Vector
from gz_course.sim.gz.sim.sdf.description import Model, Plugin
from gz_course.sim.gz.sim.sdf.element import Element

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess

SDF_WORDS = {
    "sensor": "magnetometer",
    "magnetometer": "x y z",
}

GAUSS = 1e4
"""Gauss per tesla."""


@sensor_type("magnetometer")
class Magnetometer(SiteSensor):
    """A three-axis magnetometer, run by the Magnetometer system."""

    runs_in = "Magnetometer"
    suffix = "magnetometer"
    message_type = "gz.msgs.Magnetometer"
    use_units_gauss = True
    """True if the earth's field is in gauss; set by the system."""
    use_earth_frame_ned = True
    """True if the earth's field is along north, east, down instead of east, north, up; set by the system."""

    def read_noises(self, element: Element) -> Sequence[tuple[str, Noise]]:
        """Return the noise of each axis, in the unit of the field."""
        return [(axis, noise_at(element, f"magnetometer/{axis}")) for axis in "xyz"]

    def world_field(self) -> Vector:
        """Return the field (3,) along the world's axes, in the unit that is published."""
        coordinates = self.world.description.spherical_coordinates
        if coordinates is None or coordinates.surface_model != "EARTH_WGS84":
            return np.array(self.world.description.magnetic_field)
        latitude, longitude, _ = coordinates.spherical(self.motion.position())
        north, east, down = earth_field(latitude, longitude)
        field = np.array((north, east, down) if self.use_earth_frame_ned else (east, north, -down))
        return field * GAUSS if self.use_units_gauss else field

    def fill(self, message: Any) -> None:
        into = message.field_tesla
        into.x, into.y, into.z = self.noise.apply((self.motion.rotation().T @ self.world_field()).tolist())


@system("Magnetometer", "gz-sim-magnetometer-system")
class MagnetometerSystem(SensorSystem):
    """Runs every magnetometer; `<use_units_gauss>` and `<use_earth_frame_ned>` (both true by default) set the unit and
    the axes of the earth's field.
    """

    parameters = frozenset(("use_units_gauss", "use_earth_frame_ned"))

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        super().configure(world, model, plugin)
        self._gauss = plugin.element.flag("use_units_gauss", True)
        self._ned = plugin.element.flag("use_earth_frame_ned", True)

    def bind(self) -> None:
        super().bind()
        for sensor in self.sensors:
            if isinstance(sensor, Magnetometer):
                sensor.use_units_gauss, sensor.use_earth_frame_ned = self._gauss, self._ned
