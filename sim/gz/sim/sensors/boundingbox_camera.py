"""Bounding box camera: the boxes round all labelled models in sight, and an image with the boxes drawn.

A label comes from the Label plugin; the parts of one model with the same label share a box. `<box_type>` is `2d` (the
pixels that are visible), `full_2d` (the whole object as it would be without what hides it, cut at the edge of the
image) or `3d`. Corners of 2-D boxes are in pixels from the upper left. A 3-D box has the axes of its visual, or of
the link if several visuals share it; as in Gazebo centre [m] and orientation are in OpenGL's frame of the camera (x
right, y up, z backward). Boxes are on the sensor's topic as `AnnotatedAxisAligned2DBox_V` or
`AnnotatedOriented3DBox_V`, the image on the same topic with `_image`.

Source: https://github.com/gazebosim/gz-sensors/blob/gz-sensors8/src/BoundingBoxCameraSensor.cc
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.physics.builder import VISUAL_GROUP, scoped
from gz_course.sim.gz.sim.plugins.sensor import sensor_type
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.rendering.camera_sensor import CameraSensor
from gz_course.sim.gz.sim.rendering.geom_parts import geom_parts
from gz_course.sim.gz.sim.rendering.outline import corners_of, outline_of
from gz_course.sim.gz.sim.rendering.shading import Shader
from gz_course.sim.gz.sim.rendering.viewpoint import Floats
from gz_course.sim.gz.sim.sdf.description import Sensor
from gz_course.sim.gz.sim.sensors.camera import to_bytes
from gz_course.sim.gz.sim.systems.label import label_of

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess

SDF_WORDS = {
    "camera": "box_type",
}

VISIBLE, FULL, SOLID = "2d", "full_2d", "3d"
_TYPES = {
    "2d": VISIBLE,
    "visible_2d": VISIBLE,
    "visible_box_2d": VISIBLE,
    "full_2d": FULL,
    "full_box_2d": FULL,
    "3d": SOLID,
}
_OPTICAL = Pose(quaternion=(0.5, -0.5, 0.5, 0.5))
"""The camera's frame (x forward) in OpenGL's frame of the camera."""
_GREEN = 0, 255, 0
_EDGES = [(0, 1), (0, 2), (0, 4), (1, 3), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 6), (5, 7), (6, 7)]


@dataclass(frozen=True)
class Flat:
    """A box in the image: its label, and its least and largest corner (x, y) [px]."""

    label: int
    low: tuple[float, float]
    high: tuple[float, float]


@dataclass(frozen=True)
class Solid:
    """A box in space: its label, the pose of its centre in the camera's frame (x forward), and its edges [m]."""

    label: int
    pose: Pose
    size: tuple[float, float, float]


@dataclass(eq=False)
class _Object:
    """What shares a box: its label, the MuJoCo body of its first link, and its geoms."""

    label: int
    body: int
    geoms: list[int]


@sensor_type("boundingbox_camera", "boundingbox")
class BoundingBoxCamera(CameraSensor):
    """A camera that finds labelled objects, run by the Sensors system."""

    def __init__(self, world: WorldAccess, description: Sensor) -> None:
        super().__init__(world, description)
        stated = self.camera.text_of("box_type", VISIBLE)
        if stated not in _TYPES:
            hint = did_you_mean(stated, _TYPES, listing="known names are")
            raise self.camera.error(f"<box_type> '{stated}' is not known{hint}")
        self.box_type = _TYPES[stated]
        self._shader = Shader(world)

    def topic_suffix(self) -> str:
        return "boundingbox"

    def published(self) -> dict[str, str]:
        boxes = "AnnotatedOriented3DBox_V" if self.box_type == SOLID else "AnnotatedAxisAligned2DBox_V"
        return {"": boxes, "_image": "Image"}

    def bind(self) -> None:
        """Find the labelled objects and their geoms."""
        super().bind()
        self._shader.bind()
        model = self.world.model
        found: dict[tuple[str, int], _Object] = {}
        self._object_of = np.full(model.ngeom + 1, -1)
        for geom, owner, link, part, _ in geom_parts(self.world, VISUAL_GROUP):
            label = label_of(owner, link, part)
            if label:
                body = int(model.body(scoped(owner, link.name)).id) if not owner.static and not link.static else 0
                known = found.setdefault((owner.name, label), _Object(label, body, []))
                known.geoms.append(geom)
                self._object_of[geom] = list(found).index((owner.name, label))
        self._objects = list(found.values())
        self._outlines = {geom: outline_of(model, geom) for each in self._objects for geom in each.geoms}

    def boxes(self) -> list[Flat] | list[Solid]:
        """Return the boxes of all objects in sight."""
        return self._boxes(self.cast().geom)

    def _boxes(self, geoms: NDArray[np.int32]) -> list[Flat] | list[Solid]:
        shown = self._object_of[geoms].reshape(self.pinhole.height, self.pinhole.width)
        numbers = [number for number in np.unique(shown).tolist() if number >= 0]
        if self.box_type == SOLID:
            return [self._solid(self._objects[number]) for number in numbers]
        find = self._full if self.box_type == FULL else self._visible
        return [find(number, shown) for number in numbers]

    def _visible(self, number: int, shown: NDArray[Any]) -> Flat:
        rows, columns = np.nonzero(shown == number)
        low, high = (int(columns.min()), int(rows.min())), (int(columns.max()), int(rows.max()))
        return Flat(self._objects[number].label, low, high)

    def _full(self, number: int, shown: NDArray[Any]) -> Flat:
        """Project the outlines of all parts, as far as they are before the camera."""
        each = self._objects[number]
        points = np.concatenate([self._in_camera(geom, self._outlines[geom]) for geom in each.geoms])
        pixels = self._projected(points[points[:, 0] > self.pinhole.near])
        last = (self.pinhole.width - 1, self.pinhole.height - 1)
        if len(pixels) < len(points):  # what reaches behind the camera may fill the image to its edge
            return self._visible(number, shown)
        low, high = np.clip(pixels.min(axis=0), 0, last), np.clip(pixels.max(axis=0), 0, last)
        return Flat(each.label, (low.item(0), low.item(1)), (high.item(0), high.item(1)))

    def _solid(self, each: _Object) -> Solid:
        """Return the box of an object with the axes of its only geom, or else of its link."""
        data = self.world.data
        if len(each.geoms) == 1:
            axes = data.geom_xmat[each.geoms[0]].reshape(3, 3)
        else:
            axes = data.xmat[each.body].reshape(3, 3)
        points = np.concatenate([self._in_world(geom, self._outlines[geom]) for geom in each.geoms]) @ axes
        low, high = points.min(axis=0), points.max(axis=0)
        turn = np.zeros(4)
        mujoco.mju_mat2Quat(turn, axes.flatten())
        position, quaternion = self.caster.pose()
        centre = Pose(axes @ ((low + high) / 2.0), turn)
        x, y, z = (high - low).tolist()
        return Solid(each.label, Pose(position, quaternion).inverse() * centre, (x, y, z))

    def _in_world(self, geom: int, points: Floats) -> Floats:
        placed: Floats = points @ self.world.data.geom_xmat[geom].reshape(3, 3).T + self.world.data.geom_xpos[geom]
        return placed

    def _in_camera(self, geom: int, points: Floats) -> Floats:
        position, quaternion = self.caster.pose()
        axes = np.zeros(9)
        mujoco.mju_quat2Mat(axes, quaternion)
        placed: Floats = (self._in_world(geom, points) - position) @ axes.reshape(3, 3)
        return placed

    def _projected(self, points: Floats) -> Floats:
        """Return the pixels (n, 2) of points (n, 3) [m] before the camera."""
        fx, fy, cx, cy = self.pinhole.projection[:4]
        return np.stack((cx - fx * points[:, 1] / points[:, 0], cy - fy * points[:, 2] / points[:, 0]), axis=1)

    def look(self, now_ns: int) -> None:
        """Publish boxes and image, each if it has a subscriber."""
        view = self.cast()
        boxes = self._boxes(view.geom)
        if self.listened("_image"):
            colours = to_bytes(self._shader.colours(view)).T
            image = np.ascontiguousarray(colours).reshape(self.pinhole.height, self.pinhole.width, 3)
            for box in boxes:
                self._draw(image, box)
            self.publish_image("_image", image, "RGB_INT8", now_ns)
        if self.listened(""):
            self._publish(boxes, now_ns)

    def _publish(self, boxes: list[Flat] | list[Solid], now_ns: int) -> None:
        message = self._types[self.published()[""]]()
        self.fill_header(message.header, now_ns)
        for box in boxes:
            entry = message.annotated_box.add()
            entry.label = box.label
            to = entry.box
            if isinstance(box, Flat):
                to.min_corner.x, to.min_corner.y = box.low
                to.max_corner.x, to.max_corner.y = box.high
            else:
                pose = _OPTICAL * box.pose
                to.center.x, to.center.y, to.center.z = pose.position.tolist()
                turn = to.orientation
                turn.w, turn.x, turn.y, turn.z = pose.quaternion.tolist()
                to.boxSize.x, to.boxSize.y, to.boxSize.z = box.size
        self.publishers[""].publish(message)

    def _draw(self, image: NDArray[np.uint8], box: Flat | Solid) -> None:
        if isinstance(box, Flat):
            (left, top), (right, bottom) = box.low, box.high
            corners = np.array(((left, top), (right, top), (right, bottom), (left, bottom)))
            edges = [(0, 1), (1, 2), (2, 3), (3, 0)]
        else:
            points = np.array([box.pose.transform(corner) for corner in corners_of(np.array(box.size) / 2.0)])
            if points[:, 0].min() <= self.pinhole.near:
                return
            corners, edges = self._projected(points), _EDGES
        for start, end in edges:
            count = int(np.abs(corners[end] - corners[start]).max()) + 2
            steps = np.linspace(corners[start], corners[end], min(count, 10_000))
            x, y = np.round(steps).astype(int).T
            inside = (x >= 0) & (x < self.pinhole.width) & (y >= 0) & (y < self.pinhole.height)
            image[y[inside], x[inside]] = _GREEN
