"""Lidar, 2-D and 3-D: casts rays into the world and publishes a `LaserScan` and a point cloud.

As in Gazebo `gpu_lidar` sees visuals; `lidar` and `ray` see collision shapes. After a physics step, if due and
subscribed: rays -> ranges -> -inf / +inf out of range (REP 117) -> noise on finite ranges -> messages. The robot's own
parts are visible, except those that enclose the sensor or lie in the near clip cube. Intensities are the
`<laser_retro>` of the surfaces.

Source: https://github.com/gazebosim/gz-sensors/blob/gz-sensors8/src/GpuLidarSensor.cc
Source: https://www.ros.org/reps/rep-0117.html
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from gz_course.sim.gz.sim.physics.builder import COLLISION_GROUP, VISUAL_GROUP
from gz_course.sim.gz.sim.plugins.noise import Noise
from gz_course.sim.gz.sim.plugins.sensor import SensorBase, sensor_type
from gz_course.sim.gz.sim.rendering.geom_parts import geom_parts
from gz_course.sim.gz.sim.rendering.point_cloud import LIDAR, fill_cloud
from gz_course.sim.gz.sim.rendering.ray_caster import RayCaster, directions
from gz_course.sim.gz.sim.rendering.viewpoint import ALL_BITS, Floats
from gz_course.sim.gz.sim.sdf.description import Sensor
from gz_course.sim.gz.sim.sdf.element import Element

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node

SDF_WORDS = {
    "sensor": "lidar ray",
    "lidar": "scan range noise visibility_mask",
    "ray": "scan range noise visibility_mask",
    "scan": "horizontal vertical",
    "horizontal": "samples resolution min_angle max_angle noise",
    "vertical": "samples resolution min_angle max_angle noise",
    "range": "min max resolution",
}

MOST_RAYS = 2_000_000
"""Maximum number of rays of a lidar; a scan with more would take minutes."""
_MORE_THAN_ROUND = 6.5  # [rad]; more than 2 pi, because a full turn may be rounded


class _Sweep:
    """One scan direction: `count` angles from `minimum` to `maximum` [rad], `step` [rad] apart."""

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
            if self.count > MOST_RAYS:
                raise element.error(f"a lidar may have {MOST_RAYS} beams at most, this one has {self.count}")
        self.step = (self.maximum - self.minimum) / (self.count - 1) if self.count > 1 else 0.0
        self.angles: Floats = self.minimum + self.step * np.arange(self.count, dtype=np.float64)


@sensor_type("gpu_lidar", "gpu_ray", "lidar", "ray")
class Lidar(SensorBase):
    """A scanning range sensor; ranges are row-major from the lowest vertical angle, angles in the sensor's frame."""

    def __init__(self, world: WorldAccess, description: Sensor) -> None:
        super().__init__(world, description)
        holder = description.element.find("lidar") or description.element.find("ray")
        if holder is None:
            text = f"{description.kind} sensor '{description.name}' has no <lidar> element"
            raise description.element.error(f"{text}; give it one with <scan> and <range>")
        scan = holder.find("scan") or Element("scan", file=holder.file, line=holder.line)
        self.horizontal = _Sweep(scan.find("horizontal"), 640)
        self.vertical = _Sweep(scan.find("vertical"), 1)
        for sweep, tag in ((self.horizontal, "horizontal"), (self.vertical, "vertical")):
            if sweep.maximum - sweep.minimum > _MORE_THAN_ROUND:
                world.diagnostics.warn(
                    (scan.find(tag) or scan).where,
                    f"lidar '{description.name}' turns from {sweep.minimum:g} to {sweep.maximum:g} rad, which is more "
                    "than once round; angles are in radians, not degrees",
                )
        count = self.horizontal.count * self.vertical.count
        if count > MOST_RAYS:
            raise scan.error(f"a lidar may have {MOST_RAYS} beams at most, this one has {count}")
        reach = holder.find("range")
        self.range_min = reach.number("min", 0.0) if reach is not None else 0.0
        self.range_max = reach.number("max", 0.0) if reach is not None else 0.0
        if not 0.0 <= self.range_min < self.range_max:
            raise (reach or holder).error(
                f"<range> needs 0 <= min < max, got min {self.range_min} and max {self.range_max}"
            )
        self.noise = Noise.from_sdf(holder.find("noise"))
        self._bias = self.noise.draw_bias(self.constant_random("bias"))
        self.directions = directions(self.horizontal.angles, self.vertical.angles)
        self._group = VISUAL_GROUP if description.kind.startswith("gpu") else COLLISION_GROUP
        # Gazebo's renderer omits what is inside this cube around the sensor.
        near = self.range_min / math.sqrt(3.0) / np.max(np.abs(self.directions), axis=1)
        mask = holder.mask("visibility_mask", ALL_BITS)
        self.caster = RayCaster(world, description, self.directions, self._group, near, self.range_max, mask)
        self._scan: Any = None
        self._points: Any = None

    def bind(self) -> None:
        """Find the site, the geoms invisible to this sensor, and the reflectivity of each surface."""
        self.caster.bind()
        # The additional last entry is for rays without a hit (geom -1).
        self._retro = np.zeros(self.world.model.ngeom + 1)
        for geom, _, _, part, _ in geom_parts(self.world, self._group):
            self._retro[geom] = part.element.number("laser_retro", 0.0)
        self._reflects = bool(self._retro.any())
        if self._scan is not None:
            self._prepare_scan()

    def topic_suffix(self) -> str:
        return "scan"

    def connect(self, node: Node) -> None:
        """Advertise the scan and, as `<topic>/points`, the cloud."""
        from gz_course.sim.gz.msgs.laserscan_pb2 import LaserScan
        from gz_course.sim.gz.msgs.pointcloud_packed_pb2 import PointCloudPacked

        self._scan_type, self._points_type = LaserScan, PointCloudPacked
        self._prepare_scan()
        self._scan = node.advertise(self.topic, LaserScan)
        self._points = node.advertise(f"{self.topic}/points", PointCloudPacked)

    def has_connections(self) -> bool:
        return self._scan is not None and (self._scan.has_connections() or self._points.has_connections())

    def ranges(self) -> Floats:
        """Return the exact distances [m] along all rays: +inf beyond `range_max`, -inf below `range_min`."""
        hits = self.caster.cast()
        distances = hits.distance.copy()
        missed = distances < 0.0
        distances[distances < self.range_min] = -np.inf
        distances[missed] = np.inf
        self._intensities = self._retro[hits.geom]
        return distances

    def measure(self) -> Floats:
        """Return the ranges [m] with the noise of the current update."""
        distances = self.ranges()
        if not self.noise.silent:
            finite = np.isfinite(distances)
            noisy = self.noise.apply(distances, self._bias, self.random())
            np.minimum(np.maximum(noisy, self.range_min, out=noisy), self.range_max, out=noisy)
            np.copyto(distances, noisy, where=finite)
        return distances

    def update(self, now_ns: int) -> None:
        """Publish a scan and its points, each if it has a subscriber."""
        distances = self.measure()
        if self._scan.has_connections():
            self._publish_scan(distances, now_ns)
        if self._points.has_connections():
            self._publish_points(distances, now_ns)

    def _publish_scan(self, distances: Floats, now_ns: int) -> None:
        message = self._scan_type()
        message.CopyFrom(self._constant)
        header = message.header
        header.stamp.sec, header.stamp.nsec = divmod(now_ns, 1_000_000_000)
        header.data[-1].value[0] = str(self.updates)
        # Parsing numbers that are packed already is much faster than adding them one by one.
        message.MergeFromString(self._before_ranges + distances.astype("<f8").tobytes())
        if self._reflects:
            message.intensities.extend(self._intensities.tolist())
        pose = message.world_pose
        position, turn = self.caster.pose()
        pose.position.x, pose.position.y, pose.position.z = position.tolist()
        pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z = turn.tolist()
        self._scan.publish(message)

    def _prepare_scan(self) -> None:
        """Make the part of a scan that is the same in all, and the bytes before its ranges."""
        message = self._constant = self._scan_type()
        self.fill_header(message.header, 0)
        message.frame = self.frame_id
        message.angle_min, message.angle_max = self.horizontal.minimum, self.horizontal.maximum
        message.angle_step, message.count = self.horizontal.step, self.horizontal.count
        message.vertical_angle_min, message.vertical_angle_max = self.vertical.minimum, self.vertical.maximum
        message.vertical_angle_step, message.vertical_count = self.vertical.step, self.vertical.count
        message.range_min, message.range_max = self.range_min, self.range_max
        count = len(self.directions)
        field = message.DESCRIPTOR.fields_by_name["ranges"].number
        self._before_ranges = _varint(field << 3 | 2) + _varint(8 * count)
        if not self._reflects:
            message.intensities.extend([0.0] * count)

    def _publish_points(self, distances: Floats, now_ns: int) -> None:
        message = self._points_type()
        self.fill_header(message.header, now_ns)
        points = np.zeros(len(distances), dtype=LIDAR)
        with np.errstate(invalid="ignore"):  # inf * 0 along an axis with zero slope
            points["x"], points["y"], points["z"] = (self.directions * distances[:, None]).T
        points["intensity"] = self._intensities
        points["ring"] = np.repeat(np.arange(self.vertical.count), self.horizontal.count)
        fill_cloud(message, points, self.vertical.count, self.horizontal.count)
        self._points.publish(message)


def _varint(value: int) -> bytes:
    """Return a number as protobuf writes it before packed fields.

    Source: https://protobuf.dev/programming-guides/encoding/#varints
    """
    found = bytearray()
    while value > 0x7F:
        found.append(value & 0x7F | 0x80)
        value >>= 7
    return bytes((*found, value))
