"""Logical camera: names and poses of the models in view, as `gz.msgs.LogicalCameraImage`.

The LogicalCamera system runs it. A model is in view if its origin is inside the frustum along the sensor's x axis;
occlusion is ignored. The frustum itself is published on `<topic>/frustum`.

Source: https://github.com/gazebosim/gz-sensors/blob/gz-sensors8/src/LogicalCameraSensor.cc
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from gz_course.sim.gz.sim.plugins.noise import Noise
from gz_course.sim.gz.sim.plugins.sensor import sensor_type
from gz_course.sim.gz.sim.plugins.sensor_system import sensor_system
from gz_course.sim.gz.sim.plugins.site_sensor import SiteSensor
from gz_course.sim.gz.sim.pose import Pose, Vector
from gz_course.sim.gz.sim.sdf.description import Sensor
from gz_course.sim.gz.sim.sdf.element import Element

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node

SDF_WORDS = {
    "sensor": "logical_camera",
    "logical_camera": "near far aspect_ratio horizontal_fov",
}


@sensor_type("logical_camera")
class LogicalCamera(SiteSensor):
    """Sees all models, including nested ones and its own, in the order of their names."""

    runs_in = sensor_system("LogicalCamera", "gz-sim-logical-camera-system")
    suffix = "logical_camera"
    message_type = "gz.msgs.LogicalCameraImage"

    def __init__(self, world: WorldAccess, description: Sensor) -> None:
        """Read `<logical_camera>` with SDF's defaults. Raises SdfError for an impossible frustum."""
        super().__init__(world, description)
        element = description.element
        camera = element.find("logical_camera") or Element("logical_camera", file=element.file, line=element.line)
        self.near, self.far = camera.number("near", 0.0), camera.number("far", 1.0)
        self.horizontal_fov = camera.number("horizontal_fov", 1.0)
        """Horizontal angle of view [rad]."""
        self.aspect_ratio = camera.number("aspect_ratio", 1.0)
        """Width of the frustum divided by its height."""
        if not (0.0 <= self.near < self.far < math.inf):
            raise camera.error(f"<logical_camera> needs 0 <= near < far, got near {self.near} and far {self.far}")
        if not (0.0 < self.horizontal_fov < math.pi and 0.0 < self.aspect_ratio < math.inf):
            raise camera.error(
                "<logical_camera> needs a <horizontal_fov> between 0 and pi and an <aspect_ratio> above 0, "
                f"got {self.horizontal_fov} and {self.aspect_ratio}"
            )
        self._frustum: Any = None

    def read_noises(self, element: Element) -> Sequence[tuple[str, Noise]]:
        return []

    def connect(self, node: Node) -> None:
        from gz_course.sim.gz.msgs.logical_camera_sensor_pb2 import LogicalCameraSensor

        super().connect(node)
        self._frustum_type = LogicalCameraSensor
        self._frustum = node.advertise(f"{self.topic}/frustum", LogicalCameraSensor)

    def has_connections(self) -> bool:
        return super().has_connections() or (self._frustum is not None and self._frustum.has_connections())

    def update(self, now_ns: int) -> None:
        super().update(now_ns)
        if self._frustum.has_connections():
            message = self._frustum_type(near_clip=self.near, far_clip=self.far)
            message.horizontal_fov, message.aspect_ratio = self.horizontal_fov, self.aspect_ratio
            self.fill_header(message.header, now_ns)
            del message.header.data[1]
            self._frustum.publish(message)

    def contains(self, point: Vector) -> bool:
        """Tell whether a point (3,) in the sensor's frame [m] is inside the frustum or on its surface."""
        ahead, left, up = (float(value) for value in point)
        across = math.tan(self.horizontal_fov / 2.0) * ahead
        return self.near <= ahead <= self.far and abs(left) <= across and abs(up) <= across / self.aspect_ratio

    def fill(self, message: Any) -> None:
        here = Pose(self.motion.position(), self.motion.quaternion())
        _set(message.pose, here)
        del message.model[:]
        seen = {name: here.inverse() * pose for name, pose in self._models()}
        for name in sorted(seen):
            if self.contains(seen[name].position):
                model = message.model.add(name=name)
                _set(model.pose, seen[name])

    def _models(self) -> Iterator[tuple[str, Pose]]:
        """Yield the name (without scope) and the pose in the world of every model."""
        for model in self.world.description.models:
            yield model.name, self.world.truth.pose(model.name)
            for nested in model.nested:
                link = model.link(nested.canonical_link)
                if link is not None:
                    now = self.world.truth.link_pose(model.name, link.name)
                    yield nested.name.rpartition("::")[2], now * link.pose.inverse() * nested.pose


def _set(into: Any, pose: Pose) -> None:
    into.position.x, into.position.y, into.position.z = pose.position.tolist()
    turn = into.orientation
    turn.w, turn.x, turn.y, turn.z = pose.quaternion.tolist()
