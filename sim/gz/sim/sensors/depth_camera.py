"""Depth camera: the distance of every pixel along the optical axis, and a cloud of coloured points.

Depths are float32 [m]: -inf nearer than the near clip plane, +inf beyond the far one and without a hit. A surface
before the near plane is reported as too near; it is not transparent.

Source: https://github.com/gazebosim/gz-sensors/blob/gz-sensors8/src/DepthCameraSensor.cc
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.plugins.sensor import sensor_type
from gz_course.sim.gz.sim.rendering.camera_sensor import CameraSensor
from gz_course.sim.gz.sim.rendering.point_cloud import COLOURED, pack_rgb
from gz_course.sim.gz.sim.rendering.shading import Shader
from gz_course.sim.gz.sim.rendering.tile_caster import View
from gz_course.sim.gz.sim.sdf.description import Sensor
from gz_course.sim.gz.sim.sensors.camera import to_bytes

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess

SDF_WORDS = {
    "camera": "depth_camera",
    "depth_camera": "output clip",
}


class DepthSensing(CameraSensor):
    """Base of depth cameras and RGBD cameras."""

    near_hides = False

    def __init__(self, world: WorldAccess, description: Sensor) -> None:
        super().__init__(world, description)
        self.shader = Shader(world)
        left, up = self.pinhole.slopes()
        self._slopes = np.stack((np.ones_like(left), left, up))

    def bind(self) -> None:
        super().bind()
        self.shader.bind()

    def depths(self, view: View) -> NDArray[np.float32]:
        """Return the present depth image (height, width) [m], with the noise of the current update."""
        depth = self.depth(view)
        if not self.noise.silent:
            finite = np.isfinite(depth)
            depth[finite] = self.noise.apply(depth, 0.0, self.random("depth"))[finite]
        depth[depth < self.pinhole.near] = -np.inf
        depth[depth > self.pinhole.far] = np.inf
        return depth.astype("<f4").reshape(self.pinhole.height, self.pinhole.width)

    def points(self, depth: NDArray[np.float32], colours: NDArray[np.floating[Any]]) -> NDArray[Any]:
        """Return a coloured point for every pixel, in the sensor's frame (x forward, y left, z up)."""
        points = np.zeros(depth.size, dtype=COLOURED)
        with np.errstate(invalid="ignore"):  # inf * 0 along an axis with zero slope
            points["x"], points["y"], points["z"] = self._slopes * depth.ravel()
        points["rgb"] = pack_rgb(to_bytes(colours))
        return points


@sensor_type("depth_camera", "depth")
class DepthCamera(DepthSensing):
    """A camera that measures depth."""

    wanted: ClassVar = {"": "Image", "/points": "PointCloudPacked"}

    def topic_suffix(self) -> str:
        return "depth_image"

    def look(self, now_ns: int) -> None:
        coloured = self.listened("/points")
        view = self.cast()
        depth = self.depths(view)
        if self.listened(""):
            self.publish_image("", depth, "R_FLOAT32", now_ns)
        if coloured:
            self.publish_cloud("/points", self.points(depth, self.shader.colours(view)), now_ns)
