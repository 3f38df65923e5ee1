"""Air pressure at the height of the sensor, as `gz.msgs.FluidPressure`.

The atmosphere is the International Standard Atmosphere, whose sea level is at the height zero of the world. As in
Gazebo neither `<atmosphere>` nor the elevation of `<spherical_coordinates>` changes it.

Source: U.S. Standard Atmosphere, 1976 (NOAA-S/T 76-1562)
Source: https://github.com/gazebosim/gz-sensors/blob/gz-sensors8/src/AirPressureSensor.cc
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from gz_course.sim.gz.sim.plugins.noise import Noise
from gz_course.sim.gz.sim.plugins.sensor import sensor_type
from gz_course.sim.gz.sim.plugins.sensor_system import sensor_system
from gz_course.sim.gz.sim.plugins.site_sensor import SiteSensor, noise_at
from gz_course.sim.gz.sim.sdf.description import Sensor
from gz_course.sim.gz.sim.sdf.element import Element

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess

SDF_WORDS = {
    "sensor": "air_pressure",
    "air_pressure": "reference_altitude pressure",
    "pressure": "noise range",
}

SEA_LEVEL_PRESSURE = 101325.0
"""[Pa]"""
SEA_LEVEL_TEMPERATURE = 288.15
"""[K]"""
LAPSE_RATE = 0.0065
"""[K/m]"""
EARTH_RADIUS = 6356766.0
"""The radius of the earth [m] in the formula of the geopotential height."""
EXPONENT = 9.80665 * 28.9644 / (8314.32 * LAPSE_RATE)
"""g M / (R L): gravity [m/s^2], molar mass of air [kg/kmol], gas constant [J/(kmol K)], lapse rate [K/m]."""
HIGHEST = 44_000.0
"""Height [m] at which the pressure in the formula of the troposphere becomes zero."""


def standard_temperature(height: float) -> float:
    """Return the temperature [K] of the standard atmosphere at a height [m]."""
    height = min(height, HIGHEST)
    return SEA_LEVEL_TEMPERATURE - LAPSE_RATE * EARTH_RADIUS * height / (EARTH_RADIUS + height)


def standard_pressure(height: float) -> float:
    """Return the pressure [Pa] of the standard atmosphere at a height [m]."""
    return SEA_LEVEL_PRESSURE * float(math.pow(standard_temperature(height) / SEA_LEVEL_TEMPERATURE, EXPONENT))


@sensor_type("air_pressure")
class AirPressure(SiteSensor):
    """A barometer, run by the AirPressure system."""

    runs_in = sensor_system("AirPressure", "gz-sim-air-pressure-system")
    suffix = "air_pressure"
    message_type = "gz.msgs.FluidPressure"

    def __init__(self, world: WorldAccess, description: Sensor) -> None:
        """Read `<air_pressure>`; warns that its `<reference_altitude>` has no effect, as in Gazebo."""
        super().__init__(world, description)
        altitude = description.element.find("air_pressure/reference_altitude")
        if altitude is not None and description.element.number("air_pressure/reference_altitude", 0.0) != 0.0:
            text = "<reference_altitude> has no effect, as in Gazebo; put the model at that height instead"
            world.diagnostics.warn(altitude.where, text)
        # Gazebo sends the square root of the standard deviation as the variance.
        self._variance = math.sqrt(noise_at(description.element, "air_pressure/pressure").stddev)

    def read_noises(self, element: Element) -> Sequence[tuple[str, Noise]]:
        """Return the noise of the pressure, in [Pa]."""
        return [("pressure", noise_at(element, "air_pressure/pressure"))]

    def fill(self, message: Any) -> None:
        pressure = standard_pressure(float(self.motion.position()[2]))
        message.pressure = self.noise.apply([pressure])[0]
        message.variance = self._variance
