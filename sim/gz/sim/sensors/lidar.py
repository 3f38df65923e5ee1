"""Lidar: casts rays into the world and publishes a `LaserScan`.

`gpu_lidar` sees what is visible (visuals), as in Gazebo; `lidar` and `ray` see the collision shapes. After a
physics step, when due and listened to: rays -> ranges -> out of range as -inf / +inf (REP 117) -> noise on
finite ranges -> message. The robot's own parts are seen too, except those that enclose the sensor and what
lies in the near clip cube.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from gz.sim.physics.builder import COLLISION_GROUP, SITE_GROUP, VISUAL_GROUP
from gz.sim.sdf.description import Sensor
from gz.sim.sdf.element import Element
from gz.sim.sensors.noise import Noise
from gz.sim.sensors.registry import SensorBase, sensor_type

if TYPE_CHECKING:
    from gz.sim.world import World
    from gz.transport import Node


class _Sweep:
    """One direction of scanning: `count` angles from `minimum` to `maximum` (rad), `step` apart."""

    def __init__(self, element: Element | None, default_count: int) -> None:
        self.count, self.minimum, self.maximum = default_count, 0.0, 0.0
        if element is not None:
            samples = element.integer("samples", default_count if default_count > 1 else 1)
            resolution = element.number("resolution", 1.0)
            self.minimum = element.number("min_angle", 0.0)
            self.maximum = element.number("max_angle", 0.0)
            if not 1 <= samples <= 1_000_000 or not 0.0 < resolution < 1e3:
                raise element.error(
                    f"<samples> must be at least 1 and <resolution> positive, got {samples}, {resolution}"
                )
            if not (math.isfinite(self.minimum) and math.isfinite(self.maximum)) or self.minimum > self.maximum:
                raise element.error(f"<min_angle> ({self.minimum}) must not be above <max_angle> ({self.maximum})")
            self.count = max(1, int(samples * resolution))
        self.step = (self.maximum - self.minimum) / (self.count - 1) if self.count > 1 else 0.0
        self.angles = self.minimum + self.step * np.arange(self.count)


@sensor_type("gpu_lidar", "gpu_ray", "lidar", "ray")
class Lidar(SensorBase):
    """A scanning range sensor. Ranges are row major, lowest vertical angle first; angles in the sensor's
    frame.
    """

    def __init__(self, world: World, description: Sensor) -> None:
        super().__init__(world, description)
        holder = description.element.find("lidar") or description.element.find("ray")
        if holder is None:
            raise description.element.error(f"{description.kind} sensor '{description.name}' needs a <lidar> element")
        scan = holder.find("scan") or Element("scan", file=holder.file, line=holder.line)
        self.horizontal = _Sweep(scan.find("horizontal"), 640)
        self.vertical = _Sweep(scan.find("vertical"), 1)
        reach = holder.find("range")
        self.range_min = reach.number("min", 0.0) if reach is not None else 0.0
        self.range_max = reach.number("max", 0.0) if reach is not None else 0.0
        if not 0.0 <= self.range_min < self.range_max:
            raise (reach or holder).error(
                f"<range> needs 0 <= min < max, got min {self.range_min} and max {self.range_max}"
            )
        self.noise = Noise.from_sdf(holder.find("noise"))
        self._bias = self.noise.draw_bias(self.constant_random("bias"))
        self._directions = _directions(self.horizontal.angles, self.vertical.angles)
        count = len(self._directions)
        self._ids = np.zeros(count, dtype=np.int32)
        self._distances = np.zeros(count)
        group = VISUAL_GROUP if description.kind.startswith("gpu") else COLLISION_GROUP
        self._groups = np.zeros(6, dtype=np.uint8)
        self._groups[group] = 1
        # Gazebo's rendering leaves out what lies in this cube round the sensor.
        self._clip = self.range_min / math.sqrt(3.0)
        largest = np.max(np.abs(self._directions), axis=1)
        self._clip_distances = self._clip / largest
        self._publisher: Any = None
        self._group = group

    def bind(self) -> None:
        """Find the site and the sensor's own housing."""
        self._site = self.world.model.site(self.scoped_name).id
        self._enclosing = self._find_enclosing(self._group)

    def topic_suffix(self) -> str:
        """Gazebo's last part of a lidar topic."""
        return "scan"

    def connect(self, node: Node) -> None:
        """Advertise the scan."""
        from gz.msgs.laserscan_pb2 import LaserScan

        self._type = LaserScan
        self._publisher = node.advertise(self.topic, LaserScan)

    def has_connections(self) -> bool:
        """Tell whether anybody listens to the scan."""
        return self._publisher is not None and self._publisher.has_connections()

    def _find_enclosing(self, group: int) -> list[int]:
        """Return the geoms of the sensor's own model that contain its origin (a housing): its rays start
        inside them.
        """
        model, data = self.world.model, self.world.data
        self.world.refresh()
        origin = data.site_xpos[self._site]
        prefix = self.description.model + "::"
        found = []
        for geom in range(model.ngeom):
            if model.geom_group[geom] == group and model.geom(geom).name.startswith(prefix):
                local = data.geom_xmat[geom].reshape(3, 3).T @ (origin - data.geom_xpos[geom])
                if _contains(int(model.geom_type[geom]), model.geom_size[geom], local):
                    found.append(geom)
        return found

    def ranges(self) -> NDArray[np.float64]:
        """Return the exact distances (m) along all rays now: +inf beyond `range_max`, -inf below `range_min`,
        no noise.
        """
        world = self.world
        world.refresh()
        model, data = world.model, world.data
        origin = data.site_xpos[self._site].copy()
        turn = data.site_xmat[self._site].reshape(3, 3)
        rays = self._directions @ turn.T
        groups = model.geom_group[self._enclosing].copy() if self._enclosing else None
        if groups is not None:
            model.geom_group[self._enclosing] = SITE_GROUP
        try:
            mujoco.mj_multiRay(
                model, data, origin, rays.ravel(), self._groups, True, -1,
                self._ids, self._distances, None, len(rays), self.range_max,
            )  # fmt: skip
            distances = self._distances.copy()
            near = np.flatnonzero((distances >= 0.0) & (distances < self._clip_distances))
            for ray in near:
                skip = self._clip_distances[ray]
                beyond = mujoco.mj_ray(
                    model, data, origin + skip * rays[ray], rays[ray], self._groups, True, -1, self._ids[:1]
                )
                distances[ray] = skip + beyond if beyond >= 0.0 else -1.0
        finally:
            if groups is not None:
                model.geom_group[self._enclosing] = groups
        missed = (distances < 0.0) | (distances > self.range_max)
        distances[distances < self.range_min] = -np.inf
        distances[missed] = np.inf
        return distances

    def measure(self) -> NDArray[np.float64]:
        """Return the ranges (m) with the noise of the current update."""
        distances = self.ranges()
        if not self.noise.silent:
            finite = np.isfinite(distances)
            noisy = self.noise.apply(distances, self._bias, self.random())
            distances[finite] = np.clip(noisy[finite], self.range_min, self.range_max)
        return distances

    def update(self, now_ns: int) -> None:
        """Publish one scan."""
        message = self._type()
        self.fill_header(message.header, now_ns)
        message.frame = self.frame_id
        pose = message.world_pose
        position = self.world.data.site_xpos[self._site]
        message.ranges.extend(self.measure().tolist())
        pose.position.x, pose.position.y, pose.position.z = position.tolist()
        turn = np.zeros(4)
        mujoco.mju_mat2Quat(turn, self.world.data.site_xmat[self._site])
        pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z = turn.tolist()
        message.angle_min, message.angle_max = self.horizontal.minimum, self.horizontal.maximum
        message.angle_step, message.count = self.horizontal.step, self.horizontal.count
        message.vertical_angle_min, message.vertical_angle_max = self.vertical.minimum, self.vertical.maximum
        message.vertical_angle_step, message.vertical_count = self.vertical.step, self.vertical.count
        message.range_min, message.range_max = self.range_min, self.range_max
        message.intensities.extend([0.0] * len(message.ranges))
        self._publisher.publish(message)


def _directions(horizontal: NDArray[np.floating[Any]], vertical: NDArray[np.floating[Any]]) -> NDArray[np.float64]:
    """Return unit vectors (n, 3): x ahead, y left, z up; one row of horizontal angles after the other."""
    azimuth = np.tile(horizontal, len(vertical))
    elevation = np.repeat(vertical, len(horizontal))
    across = np.cos(elevation)
    return np.stack((across * np.cos(azimuth), across * np.sin(azimuth), np.sin(elevation)), axis=1)


def _contains(kind: int, size: NDArray[np.float64], point: NDArray[np.float64]) -> bool:
    """Tell whether a primitive geom with half sizes `size` contains a point given in its own frame."""
    geom = mujoco.mjtGeom
    x, y, z = (float(value) for value in point)
    if kind == geom.mjGEOM_SPHERE:
        return x * x + y * y + z * z < size[0] ** 2
    if kind == geom.mjGEOM_BOX:
        return bool(np.all(np.abs(point) < size))
    if kind == geom.mjGEOM_CYLINDER:
        return x * x + y * y < size[0] ** 2 and abs(z) < size[1]
    if kind == geom.mjGEOM_CAPSULE:
        cap = max(0.0, abs(z) - float(size[1]))
        return x * x + y * y + cap * cap < size[0] ** 2
    if kind == geom.mjGEOM_ELLIPSOID:
        return float(np.sum((point / size) ** 2)) < 1.0
    return False
