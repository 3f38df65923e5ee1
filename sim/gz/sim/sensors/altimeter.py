"""Altimeter: height above the initial position and vertical speed, as `gz.msgs.Altimeter`.

The Altimeter system runs it.

Source: https://github.com/gazebosim/gz-sensors/blob/gz-sensors8/src/AltimeterSensor.cc
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from gz_course.sim.gz.sim.plugins.noise import Noise
from gz_course.sim.gz.sim.plugins.sensor import sensor_type
from gz_course.sim.gz.sim.plugins.sensor_system import sensor_system
from gz_course.sim.gz.sim.plugins.site_sensor import SiteSensor, noise_at
from gz_course.sim.gz.sim.sdf.element import Element

SDF_WORDS = {
    "sensor": "altimeter",
    "altimeter": "vertical_position vertical_velocity",
    "vertical_position": "noise",
    "vertical_velocity": "noise",
}


@sensor_type("altimeter")
class Altimeter(SiteSensor):
    """Measures along the world's z axis."""

    runs_in = sensor_system("Altimeter", "gz-sim-altimeter-system")
    suffix = "altimeter"
    message_type = "gz.msgs.Altimeter"
    reference = 0.0
    """Height [m] of the sensor in the world at the start, the zero of the reported positions."""

    def read_noises(self, element: Element) -> Sequence[tuple[str, Noise]]:
        """Return the noises of the position [m] and of the velocity [m/s]."""
        return [(tag, noise_at(element, f"altimeter/{tag}")) for tag in ("vertical_position", "vertical_velocity")]

    def start(self) -> None:
        """Begin the schedule with the present height as zero."""
        super().start()
        self.reference = float(self.motion.position()[2])

    def fill(self, message: Any) -> None:
        linear, _ = self.motion.velocity(local=False)
        measured = [self.motion.position()[2].item() - self.reference, linear[2].item()]
        message.vertical_position, message.vertical_velocity = self.noise.apply(measured)
        message.vertical_reference = self.reference
