"""RGBD camera: colour image, depth image and coloured points from one cast of rays.

Source: https://github.com/gazebosim/gz-sensors/blob/gz-sensors8/src/RgbdCameraSensor.cc
"""

from __future__ import annotations

from typing import ClassVar

from gz_course.sim.gz.sim.plugins.sensor import sensor_type
from gz_course.sim.gz.sim.sensors.camera import encode
from gz_course.sim.gz.sim.sensors.depth_camera import DepthSensing


@sensor_type("rgbd_camera", "rgbd")
class RgbdCamera(DepthSensing):
    """A camera for colour and depth; its topics are below `<topic>`."""

    info_beside = False
    wanted: ClassVar = {"/image": "Image", "/depth_image": "Image", "/points": "PointCloudPacked"}

    def topic_suffix(self) -> str:
        return ""

    def look(self, now_ns: int) -> None:
        coloured = self.listened("/image") or self.listened("/points")
        view = self.cast()
        depth = self.depths(view)
        if self.listened("/depth_image"):
            self.publish_image("/depth_image", depth, "R_FLOAT32", now_ns)
        if not coloured:
            return
        colours = self.shader.colours(view)
        if self.listened("/image"):
            noisy = colours if self.noise.silent else self.noise.apply(colours, 0.0, self.random())
            image = encode(noisy, self.pinhole.height, self.pinhole.width, "RGB_INT8")
            self.publish_image("/image", image, "RGB_INT8", now_ns)
        if self.listened("/points"):
            self.publish_cloud("/points", self.points(depth, colours), now_ns)
