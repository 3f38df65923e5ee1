"""Segmentation camera: the label of each pixel, as an image of numbers and one of colours.

Labels come from the Label plugin of visuals and models. A semantic map repeats the label in all three channels. In a
panoptic (instance) map channels 0 and 1 hold the low and high byte of the instance number and channel 2 the label; all
links of one model are one instance, numbered from 1 per label in file order. Pixels without a label are 0 and black.
The colour of a label is always the same.

Source: https://github.com/gazebosim/gz-sensors/blob/gz-sensors8/src/SegmentationCameraSensor.cc
"""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import NDArray

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.physics.builder import VISUAL_GROUP
from gz_course.sim.gz.sim.plugins.sensor import sensor_type
from gz_course.sim.gz.sim.rendering.camera_sensor import CameraSensor
from gz_course.sim.gz.sim.rendering.geom_parts import geom_parts
from gz_course.sim.gz.sim.sdf.description import Sensor
from gz_course.sim.gz.sim.systems.label import label_of

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess

SDF_WORDS = {
    "camera": "segmentation_type",
}

_PANOPTIC = {"semantic": False, "instance": True, "panoptic": True}


def label_colour(number: int) -> tuple[int, int, int]:
    """Return the colour of a label or instance; 0 is black."""
    if number == 0:
        return 0, 0, 0
    digest = hashlib.sha256(f"label {number}".encode()).digest()
    return digest[0], digest[1], digest[2]


@sensor_type("segmentation_camera", "segmentation")
class SegmentationCamera(CameraSensor):
    """A camera that sees labels instead of colours, run by the Sensors system."""

    info_beside = False
    wanted: ClassVar = {"/colored_map": "Image", "/labels_map": "Image"}

    def __init__(self, world: WorldAccess, description: Sensor) -> None:
        super().__init__(world, description)
        kind = self.camera.text_of("segmentation_type", "semantic").lower()
        if kind not in _PANOPTIC:
            hint = did_you_mean(kind, _PANOPTIC, listing="known names are")
            raise self.camera.error(f"<segmentation_type> '{kind}' is not known{hint}")
        self.panoptic = _PANOPTIC[kind]

    def topic_suffix(self) -> str:
        return "segmentation"

    def bind(self) -> None:
        """Look up the label, instance and colour of every visible geom."""
        super().bind()
        count = self.world.model.ngeom + 1  # the additional one is for rays without a hit (geom -1)
        self._labels = np.zeros((count, 3), dtype=np.uint8)
        self._colours = np.zeros((count, 3), dtype=np.uint8)
        instances: dict[int, dict[str, int]] = {}
        for geom, model, link, part, _ in geom_parts(self.world, VISUAL_GROUP):
            label = label_of(model, link, part)
            if label == 0:
                continue
            of_label = instances.setdefault(label, {})
            instance = of_label.setdefault(model.name, len(of_label) + 1)
            if self.panoptic:
                self._labels[geom] = instance % 256, instance // 256 % 256, label
                self._colours[geom] = label_colour(label * 65536 + instance)
            else:
                self._labels[geom] = label
                self._colours[geom] = label_colour(label)

    def maps(self) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
        """Return the map of labels and the map of colours, both (height, width, 3)."""
        geoms = self.cast().geom
        shape = (self.pinhole.height, self.pinhole.width, 3)
        return self._labels[geoms].reshape(shape), self._colours[geoms].reshape(shape)

    def look(self, now_ns: int) -> None:
        """Publish both maps, each if it has a subscriber."""
        labels, colours = self.maps()
        for suffix, image in (("/labels_map", labels), ("/colored_map", colours)):
            if self.listened(suffix):
                self.publish_image(suffix, image, "RGB_INT8", now_ns)
