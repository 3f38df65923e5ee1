"""sensor_msgs/Image and CompressedImage: colour pictures as JPEG, depth pictures as depth.

Source: https://github.com/ros2/common_interfaces/blob/jazzy/sensor_msgs/include/sensor_msgs/image_encodings.hpp
"""

from __future__ import annotations

import io
from typing import Any

import numpy as np

JPEG_QUALITY = 85
# ROS names of the supported pixel formats: Pillow's mode, its raw mode, bytes per pixel.
PIXELS = {
    "rgb8": ("RGB", "RGB", 3),
    "bgr8": ("RGB", "BGR", 3),
    "mono8": ("L", "L", 1),
    "8UC3": ("RGB", "BGR", 3),
    "8UC1": ("L", "L", 1),
    "rgba8": ("RGB", "RGBX", 4),
    "bgra8": ("RGB", "BGRX", 4),
}
DEPTHS = {"32FC1": (np.float32, 1.0), "16UC1": (np.uint16, 1000.0), "mono16": (np.uint16, 1000.0)}
MOST_HZ = 10.0


def jpeg(image: Any, kinds: Any = PIXELS) -> bytes:
    """Return an Image of a format in PIXELS as a JPEG file; empty if the picture is incomplete."""
    from PIL import Image

    mode, raw, width = kinds[image.encoding]
    data = bytes(image.data)
    if not (image.width and image.height and image.step >= width * image.width):
        return b""
    if len(data) < image.step * image.height:
        return b""
    picture = Image.frombytes(mode, (image.width, image.height), data, "raw", raw, image.step, 1)
    target = io.BytesIO()
    picture.save(target, "JPEG", quality=JPEG_QUALITY)
    return target.getvalue()


def draw(canvas: Any, entity: str, message: Any) -> None:
    import rerun as rr

    if not canvas.is_due(entity, MOST_HZ):
        return
    if message.encoding in PIXELS:
        if picture := jpeg(message):
            canvas.picture(entity, rr.EncodedImage(contents=picture, media_type="image/jpeg"))
    elif message.encoding in DEPTHS:
        kind, per_metre = DEPTHS[message.encoding]
        row = message.step // np.dtype(kind).itemsize
        numbers = np.frombuffer(bytes(message.data), dtype=kind)
        if message.is_bigendian:
            numbers = numbers.byteswap()
        if row >= message.width > 0 and len(numbers) >= row * message.height > 0:
            depth = numbers[: row * message.height].reshape(message.height, row)[:, : message.width]
            canvas.picture(entity, rr.DepthImage(np.where(np.isfinite(depth), depth, 0), meter=per_metre))
    else:
        canvas.say(f"{entity}: pictures of the encoding {message.encoding} are not drawn")


def draw_compressed(canvas: Any, entity: str, message: Any) -> None:
    import rerun as rr

    if canvas.is_due(entity, MOST_HZ):
        kind = "image/png" if "png" in message.format.lower() else "image/jpeg"
        canvas.picture(entity, rr.EncodedImage(contents=bytes(message.data), media_type=kind))


DRAWN = {"sensor_msgs/msg/Image": draw, "sensor_msgs/msg/CompressedImage": draw_compressed}
