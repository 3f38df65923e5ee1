"""Magnetometer: the magnetic field of the world along the sensor's own axes, as `gz.msgs.Magnetometer`.

The Magnetometer system runs it. The field is `<magnetic_field>` of the world, the same everywhere.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from gz.sim.sdf.element import Element
from gz.sim.sensors.noise import Noise
from gz.sim.sensors.registry import sensor_type
from gz.sim.sensors.site_sensor import SiteSensor, noise_at


@sensor_type("magnetometer")
class Magnetometer(SiteSensor):
    """Measures in tesla."""

    runs_in = "Magnetometer"
    suffix = "magnetometer"
    message_type = "gz.msgs.Magnetometer"

    def read_noises(self, element: Element) -> Sequence[tuple[str, Noise]]:
        """Return the noise of each axis (T)."""
        return [(axis, noise_at(element, f"magnetometer/{axis}")) for axis in "xyz"]

    def fill(self, message: Any) -> None:
        """Measure."""
        field = self.motion.rotation().T @ np.array(self.world.description.magnetic_field)
        into = message.field_tesla
        into.x, into.y, into.z = self.noise.apply(field).tolist()
