"""Air speed sensor (pitot tube): the dynamic pressure of the air from ahead, as `gz.msgs.AirSpeed`.

The AirSpeed system runs it. Wind is not simulated.

Source: https://github.com/gazebosim/gz-sensors/blob/gz-sensors8/src/AirSpeedSensor.cc
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from gz_course.sim.gz.sim.plugins.noise import Noise
from gz_course.sim.gz.sim.plugins.sensor import sensor_type
from gz_course.sim.gz.sim.plugins.sensor_system import sensor_system
from gz_course.sim.gz.sim.plugins.site_sensor import SiteSensor, noise_at
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.sensors.air_pressure import HIGHEST, LAPSE_RATE, SEA_LEVEL_TEMPERATURE

SDF_WORDS = {
    "sensor": "air_speed",
    "air_speed": "pressure",
    "pressure": "noise range",
}

SEA_LEVEL_DENSITY = 1.225
"""[kg/m^3]"""
DENSITY_EXPONENT = 4.256
"""Exponent of the density of the standard atmosphere as a function of its temperature."""


@sensor_type("air_speed")
class AirSpeed(SiteSensor):
    """Measures along the sensor's x axis."""

    runs_in = sensor_system("AirSpeed", "gz-sim-air-speed-system")
    suffix = "air_speed"
    message_type = "gz.msgs.AirSpeed"

    def read_noises(self, element: Element) -> Sequence[tuple[str, Noise]]:
        """Return the noise of the pressure, in [hPa] as in Gazebo."""
        return [("pressure", noise_at(element, "air_speed/pressure"))]

    def fill(self, message: Any) -> None:
        """Measure the dynamic pressure rho v |v| / 2 [Pa] and the temperature of the air [K]."""
        height = min(float(self.motion.position()[2]), HIGHEST)
        temperature = SEA_LEVEL_TEMPERATURE - LAPSE_RATE * height
        density = SEA_LEVEL_DENSITY * math.pow(temperature / SEA_LEVEL_TEMPERATURE, DENSITY_EXPONENT)
        ahead = float(self.motion.velocity(local=True)[0][0])
        hectopascals = 0.005 * density * ahead * abs(ahead)
        message.diff_pressure = 100.0 * self.noise.apply([hectopascals])[0]
        message.temperature = temperature
