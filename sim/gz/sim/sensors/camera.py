"""Camera: a colour image and its CameraInfo.

`camera_sensor` has the base class and the topics, `renderer` makes the colours. Formats are R8G8B8, L8, L16 and the
Bayer patterns; any other causes a warning and an R8G8B8 image, as in Gazebo.

Source: https://github.com/gazebosim/gz-sensors/blob/gz-sensors8/src/CameraSensor.cc
Source: ITU-R BT.601 (luminance of L8 and L16)
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.plugins.sensor import sensor_type
from gz_course.sim.gz.sim.rendering.camera_sensor import CameraSensor
from gz_course.sim.gz.sim.rendering.renderer import renderer_for
from gz_course.sim.gz.sim.sdf.description import Sensor

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess

SDF_WORDS = {
    "sensor": "camera",
    "camera": (
        "triggered trigger_topic camera_info_topic horizontal_fov image clip save noise distortion lens "
        "visibility_mask optical_frame_id pose background frame view_controller projection_type track_visual"
    ),
    "image": "width height format anti_aliasing",
    "track_visual": "name min_dist max_dist static use_model_frame xyz inherit_yaw",
    "clip": "near far",
    "save": "path @enabled",
    "distortion": "k1 k2 k3 p1 p2 center",
    "lens": "type scale_to_hfov custom_function cutoff_angle env_texture_size intrinsics projection",
    "custom_function": "c1 c2 c3 f fun",
    "intrinsics": "fx fy cx cy s",
    "projection": "p_fx p_fy p_cx p_cy tx ty",
}

FORMATS = {
    "R8G8B8": "RGB_INT8",
    "RGB_INT8": "RGB_INT8",
    "L8": "L_INT8",
    "L_INT8": "L_INT8",
    "L16": "L_INT16",
    "L_INT16": "L_INT16",
    "BAYER_RGGB8": "BAYER_RGGB8",
    "BAYER_BGGR8": "BAYER_BGGR8",
    "BAYER_GBRG8": "BAYER_GBRG8",
    "BAYER_GRBG8": "BAYER_GRBG8",
}
"""The names of gz.msgs.PixelFormatType by the pixel formats of SDF that Gazebo's cameras support."""
_LUMINANCE = np.array((0.299, 0.587, 0.114))
_BAYER = {"BAYER_RGGB8": "RGGB", "BAYER_BGGR8": "BGGR", "BAYER_GBRG8": "GBRG", "BAYER_GRBG8": "GRBG"}


def to_bytes(colours: NDArray[np.floating[Any]]) -> NDArray[np.uint8]:
    """Return colours 0..1 as rounded bytes 0..255."""
    return (np.clip(colours, 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)


def encode(colours: NDArray[np.floating[Any]], height: int, width: int, pixel_format: str) -> NDArray[Any]:
    """Return colours (3, height * width), values 0..1, as the pixels of an image of the given format."""
    if pixel_format == "L_INT8":
        return to_bytes(np.tensordot(_LUMINANCE, colours, 1)).reshape(height, width)
    if pixel_format == "L_INT16":
        return (
            (np.clip(np.tensordot(_LUMINANCE, colours, 1), 0.0, 1.0) * 65535.0 + 0.5)
            .astype("<u2")
            .reshape(height, width)
        )
    rgb = np.ascontiguousarray(to_bytes(colours).T).reshape(height, width, 3)
    if pixel_format not in _BAYER:
        return rgb
    mosaic = np.zeros((height, width), dtype=np.uint8)
    for place, colour in enumerate(_BAYER[pixel_format]):
        row, column = divmod(place, 2)
        mosaic[row::2, column::2] = rgb[row::2, column::2, "RGB".index(colour)]
    return mosaic


@sensor_type("camera")
class Camera(CameraSensor):
    """A colour camera, run by the Sensors system."""

    wanted: ClassVar = {"": "Image"}

    def __init__(self, world: WorldAccess, description: Sensor) -> None:
        super().__init__(world, description)
        image = self.camera.find("image")
        stated = image.text_of("format", "R8G8B8") if image is not None else "R8G8B8"
        self.format = FORMATS.get(stated, "RGB_INT8")
        """The name of the format in gz.msgs.PixelFormatType."""
        if image is not None and stated not in FORMATS:
            world.diagnostics.warn(
                image.where,
                f"image format '{stated}' is not one cameras make, R8G8B8 is"
                f"{did_you_mean(stated, FORMATS, listing='known names are')}",
            )
        self._renderer = renderer_for(self)

    def topic_suffix(self) -> str:
        return "image"

    def bind(self) -> None:
        super().bind()
        self._renderer.bind()

    def image(self) -> NDArray[Any]:
        """Return the present image in the camera's format, with the noise of the current update."""
        colours: NDArray[np.floating[Any]] = self._renderer.image()
        if not self.noise.silent:
            colours = self.noise.apply(colours, 0.0, self.random())
        return encode(colours, self.pinhole.height, self.pinhole.width, self.format)

    def look(self, now_ns: int) -> None:
        self.publish_image("", self.image(), self.format, now_ns)
