"""Thermal camera: the temperature of each pixel, divided by the resolution, as an image of numbers.

The image has 16 bits at 0.01 K for each unit, or with `<format>L8</format>` 8 bits at 3 K; the plugin `ThermalSensor`
states another resolution and the range. `systems/thermal.py` has the temperatures. Gaussian `<noise>` is in [K].

Source: https://github.com/gazebosim/gz-sensors/blob/gz-sensors8/src/ThermalCameraSensor.cc
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.physics.builder import VISUAL_GROUP
from gz_course.sim.gz.sim.plugins.sensor import sensor_type
from gz_course.sim.gz.sim.rendering.camera_sensor import CameraSensor
from gz_course.sim.gz.sim.rendering.geom_parts import geom_parts
from gz_course.sim.gz.sim.sdf.description import Sensor
from gz_course.sim.gz.sim.systems.thermal import ambient_temperature, parameters_of, temperature_of

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess

_RESOLUTION, _COARSE = 0.01, 3.0


@sensor_type("thermal_camera", "thermal")
class ThermalCamera(CameraSensor):
    """A camera that sees temperatures, run by the Sensors system."""

    wanted: ClassVar = {"": "Image"}

    def __init__(self, world: WorldAccess, description: Sensor) -> None:
        super().__init__(world, description)
        self.eight_bits = self.camera.text_of("image/format") in ("L8", "L_INT8")
        self.lowest, self.highest, resolution = parameters_of(description.element)
        self.resolution = _RESOLUTION if resolution is None else resolution
        if self.eight_bits and self.resolution < 1.0:
            if resolution is not None:
                text = f"8 bits need a <resolution> of at least 1 K, got {resolution:g}; it is 3 K"
                world.diagnostics.warn(description.element.where, text)
            self.resolution = _COARSE

    def topic_suffix(self) -> str:
        return "image"

    def bind(self) -> None:
        """Look up the temperature [K] of every visible geom."""
        super().bind()
        ambient = ambient_temperature(self.world.description.element)
        # The additional one is for rays without a hit (geom -1).
        self._kelvin = np.full(self.world.model.ngeom + 1, ambient)
        for geom, _, _, part, _ in geom_parts(self.world, VISUAL_GROUP):
            self._kelvin[geom] = temperature_of(part, ambient, self.world.diagnostics)

    def image(self) -> NDArray[Any]:
        """Return the present image (height, width) in units of the resolution."""
        kelvin = self._kelvin[self.cast().geom]
        if not self.noise.silent:
            kelvin = self.noise.apply(kelvin, 0.0, self.random())
        units = np.clip(kelvin, self.lowest, self.highest) / self.resolution + 1e-6
        kind = np.uint8 if self.eight_bits else np.dtype("<u2")
        limited = np.clip(units, 0, np.iinfo(kind).max)
        return limited.astype(kind).reshape(self.pinhole.height, self.pinhole.width)

    def look(self, now_ns: int) -> None:
        self.publish_image("", self.image(), "L_INT8" if self.eight_bits else "L_INT16", now_ns)
