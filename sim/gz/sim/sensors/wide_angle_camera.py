"""Wide angle camera: a colour image through a fish-eye lens.

`rendering/wide_lens.py` has the lenses. Every pixel is a ray of its own, so the image is sharp at any angle.

Source: https://github.com/gazebosim/gz-sensors/blob/gz-sensors8/src/WideAngleCameraSensor.cc
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.plugins.sensor import sensor_type
from gz_course.sim.gz.sim.rendering.camera_sensor import CameraSensor
from gz_course.sim.gz.sim.rendering.shading import Shader
from gz_course.sim.gz.sim.rendering.wide_lens import WideLens
from gz_course.sim.gz.sim.sdf.description import Sensor
from gz_course.sim.gz.sim.sensors.camera import to_bytes

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess


@sensor_type("wideanglecamera", "wide_angle_camera", "wideangle_camera")
class WideAngleCamera(CameraSensor):
    """A camera with a wide lens, run by the Sensors system."""

    lens = WideLens
    wanted: ClassVar = {"": "Image"}

    def __init__(self, world: WorldAccess, description: Sensor) -> None:
        super().__init__(world, description)
        assert isinstance(self.pinhole, WideLens)
        self._black = self.pinhole.black()
        self._shader = Shader(world)

    def topic_suffix(self) -> str:
        return "image"

    def bind(self) -> None:
        super().bind()
        self._shader.bind()

    def image(self) -> NDArray[np.uint8]:
        """Return the present image (height, width, 3), with the noise of the current update."""
        colours = self._shader.colours(self.cast())
        if not self.noise.silent:
            colours = self.noise.apply(colours, 0.0, self.random())
        colours[:, self._black] = 0.0
        return np.ascontiguousarray(to_bytes(colours).T).reshape(self.pinhole.height, self.pinhole.width, 3)

    def look(self, now_ns: int) -> None:
        self.publish_image("", self.image(), "RGB_INT8", now_ns)
