"""The world in the recording: its shapes once, then poses, truth and lidar scans tick by tick."""

from __future__ import annotations

import math
from collections import defaultdict
from typing import TYPE_CHECKING, Any

import numpy as np
import rerun as rr

from gz_course.grader.record.recorder import Recorder
from gz_course.sim.show.rviz2.drawing import laser_scan

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.world import World

FIRST_SCAN_NS = 200_000_000  # a first scan that comes so early is shown from the beginning [ns]
LINK_TICKS = 5  # ticks between two poses of links such as wheels
UNITS = {"linear_x": " [m/s]", "angular_z": " [rad/s]", "distance": " [m]", "yaw": " [rad]"}
SCAN_COLOR = np.array([[*laser_scan.COLOUR, 255]], dtype=np.uint8)
GROUND_SIZE = 20.0  # [m] side of the square drawn for an infinite plane
FACETS = 100_000  # a surface of more triangles is drawn without shading


def shape(kind: str, size: Any, color: Any) -> Any:
    """Return the archetype for one visual; sizes are full extents [m] as in SDF."""
    rgba = [round(255 * c) for c in color]
    half = [s / 2 for s in size]
    colors = np.array([rgba], dtype=np.uint8)
    if kind == "box":
        return rr.Boxes3D(half_sizes=[half], colors=colors, fill_mode="solid")
    if kind == "plane":
        side = [min(half[0] or GROUND_SIZE, GROUND_SIZE), min(half[1] or GROUND_SIZE, GROUND_SIZE), 0.001]
        return rr.Boxes3D(half_sizes=[side], centers=[[0, 0, -0.001]], colors=colors, fill_mode="solid")
    if kind in ("sphere", "ellipsoid"):
        return rr.Ellipsoids3D(half_sizes=[half], colors=colors, fill_mode="solid")
    if kind == "cylinder":
        return rr.Cylinders3D(lengths=[size[2]], radii=[half[0]], colors=colors, fill_mode="solid")
    if kind == "capsule":
        return rr.Capsules3D(
            lengths=[size[2]],
            radii=[half[0]],
            translations=[[0, 0, -half[2]]],
            colors=colors,
            fill_mode="solid",
        )
    return None


def surface(vertices: Any, triangles: Any, color: Any) -> Any:
    """Return the archetype for a surface of triangles: vertices (n, 3) [m], triangles (m, 3) indices.

    Each triangle has corners of its own, so that edges look sharp; a surface of more than FACETS triangles is drawn
    unshaded.
    """
    rgba = np.array([round(255 * c) for c in color], dtype=np.uint8)
    if len(triangles) > FACETS:
        return rr.Mesh3D(vertex_positions=vertices, triangle_indices=triangles, albedo_factor=rgba)
    corners = np.asarray(vertices)[np.asarray(triangles)]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-20)
    return rr.Mesh3D(
        vertex_positions=corners.reshape(-1, 3),
        triangle_indices=np.arange(3 * len(corners), dtype=np.uint32).reshape(-1, 3),
        vertex_normals=np.repeat(normals, 3, axis=0),
        albedo_factor=rgba,
    )


class Scene:
    """Records one world: call `tick()` after every step of simulated time.

    The true state of every moving model is recorded as `truth/MODEL/...` in double precision: position [m] and
    orientation (unit quaternion) in the world frame, yaw [rad] (unwrapped), forward speed linear_x [m/s] and yaw rate
    angular_z [rad/s] in the model's own frame, and the distance travelled [m]. A model that is created during the run
    is recorded from then on, one that is removed until then.
    """

    def __init__(self, recorder: Recorder, world: World) -> None:
        self._recorder = recorder
        self._world = world
        self._links: dict[tuple[str, str], str] = {}
        self._ticks = 0
        self._yaw: defaultdict[str, float] = defaultdict(float)
        self._distance: defaultdict[str, float] = defaultdict(float)
        self._last: dict[str, tuple[float, float, float]] = {}
        self._path: defaultdict[str, list[tuple[float, float, float]]] = defaultdict(list)
        self._drawn: set[str] = set()  # models
        self._lidars: dict[str, str] = {}  # Gazebo topic -> entity
        recorder.static("/world", rr.ViewCoordinates.RIGHT_HAND_Z_UP)
        self._began_ns = recorder.now_ns
        self._has_scanned: set[str] = set()
        self._take_models()
        self._log_poses()

    def _take_models(self) -> None:
        """Draw what is new in the world, and note what it consists of now."""
        recorder, world = self._recorder, self._world
        self._built = world.truth.model
        self._models = world.truth.model_names()
        every = world.truth.model_names(static=True)
        self._links = {key: entity for key, entity in self._links.items() if key[0] in every}
        new = {name for name in every if name not in self._drawn}
        self._drawn = set(every)
        for visual in world.truth.geometry():
            if visual.model not in new:
                continue
            entity = f"/world/{visual.model}/{visual.link}/{visual.name}"
            if visual.triangles is None:
                archetype = shape(visual.kind, [float(s) for s in visual.size], visual.rgba)
            else:
                archetype = surface(visual.vertices, visual.triangles, visual.rgba)
            if archetype is None:
                continue
            recorder.static(entity, archetype)
            recorder.static(entity, transform(visual.pose))
            self._links[(visual.model, visual.link)] = f"/world/{visual.model}/{visual.link}"
        for (model, link), entity in self._links.items():
            if model in new and model not in self._models:
                recorder.static(f"/world/{model}", transform(world.truth.pose(model)))
                recorder.static(
                    entity, transform(world.truth.pose(model).inverse() * world.truth.link_pose(model, link))
                )
        for sensor in world.systems.sensors():
            at = sensor.description
            if at.model not in new:
                continue
            entity = f"/world/{at.model}/{at.link}/{at.name}"
            self._lidars[sensor.topic] = f"{entity}/scan"
            recorder.static(entity, transform(at.pose))
            recorder.static(f"{entity}/scan", rr.Points3D.from_fields(colors=SCAN_COLOR, radii=laser_scan.RADIUS))

    def tick(self) -> None:
        """Log truth and poses at the recorder's present time."""
        recorder, world = self._recorder, self._world
        if world.truth.model is not self._built:
            self._take_models()
        for model in self._models:
            pose, velocity = world.truth.pose(model), world.truth.velocity(model)
            x, y, z = (float(v) for v in pose.position)
            qw, qx, qy, qz = (float(v) for v in pose.quaternion)
            yaw = math.atan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz))
            self._yaw[model] += math.remainder(yaw - self._yaw[model], 2 * math.pi)
            last = self._last.get(model, (x, y, z))
            self._distance[model] += math.dist(last, (x, y, z))
            self._last[model] = (x, y, z)
            # Forward speed: world velocity projected on the model's own x axis.
            forward = (1 - 2 * (qy * qy + qz * qz), 2 * (qx * qy + qw * qz), 2 * (qx * qz - qw * qy))
            linear_x = sum(float(v) * f for v, f in zip(velocity.linear, forward, strict=True))
            truth = {
                "x": x,
                "y": y,
                "z": z,
                "qw": qw,
                "qx": qx,
                "qy": qy,
                "qz": qz,
                "yaw": self._yaw[model],
                "linear_x": linear_x,
                "angular_z": float(velocity.angular[2]),
                "distance": self._distance[model],
            }
            for name, value in truth.items():
                recorder.name(f"truth/{model}/{name}", f"truth {name}{UNITS.get(name, '')}")
                recorder.scalar(f"truth/{model}/{name}", value)
            recorder.pose(f"/world/{model}", (x, y, z), (qw, qx, qy, qz))
            self._path[model].append((x, y, z))
        if self._ticks % LINK_TICKS == 0:
            self._log_links()
        self._ticks += 1

    def _log_poses(self) -> None:
        """Log where everything is before the first tick, so that the view is right from the beginning."""
        for model in self._models:
            pose = self._world.truth.pose(model)
            self._recorder.pose(f"/world/{model}", pose.position, pose.quaternion)
        self._log_links()

    def _log_links(self) -> None:
        truth = self._world.truth
        for (model, link), entity in self._links.items():
            if model in self._models:
                pose = truth.pose(model).inverse() * truth.link_pose(model, link)
                self._recorder.pose(entity, pose.position, pose.quaternion)

    def finish(self) -> None:
        """Log the path that each model took."""
        for model, path in self._path.items():
            if len(path) > 1:
                strip = rr.LineStrips3D([path], colors=np.array([[255, 170, 0, 255]], dtype=np.uint8), radii=0.01)
                self._recorder.static(f"/world/path/{model}", strip)

    def scan(self, gz_topic: str, scan: Any) -> None:
        """Log a sensor_msgs/LaserScan that came from the Gazebo topic of one of the world's lidars."""
        entity = self._lidars.get(gz_topic)
        if entity is None:
            return
        points = laser_scan.points(scan)
        if entity not in self._has_scanned and self._recorder.now_ns <= self._began_ns + FIRST_SCAN_NS:
            self._recorder.points(entity, points, self._began_ns)
        self._has_scanned.add(entity)
        self._recorder.points(entity, points)


def transform(pose: Any) -> Any:
    w, x, y, z = (float(v) for v in pose.quaternion)
    return rr.Transform3D(translation=[float(v) for v in pose.position], quaternion=rr.Quaternion(xyzw=[x, y, z, w]))
