"""The rows of a recording that a ROS message of any type becomes.

Every numeric field becomes a signal named after it: `topics/cmd_vel/linear/x`. A list of numbers becomes one row, a
text a line whenever it changes, and a picture now and then a JPEG. Messages are read by their own introspection, so no
ROS import is needed.
"""

from __future__ import annotations

import io
import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from gz_course.grader.record.recorder import Recorder

LONGEST_LIST = 20_000  # numbers; longer lists, such as images and clouds, are not stored as numbers
LONGEST_TEXT = 2_000  # characters kept of a text
JPEG_QUALITY = 85
# ROS names of the supported pixel formats: Pillow's mode, its raw mode, bytes per pixel.
PIXELS = {"rgb8": ("RGB", "RGB", 3), "bgr8": ("RGB", "BGR", 3), "mono8": ("L", "L", 1)}
SKIPPED_FIELDS = frozenset({"stamp"})  # simulated time is the timeline already


def fields(message: Any, prefix: str) -> Iterator[tuple[str, Any]]:
    for name in message.get_fields_and_field_types():
        value = getattr(message, name)
        path = f"{prefix}/{name}"
        if name in SKIPPED_FIELDS:
            continue
        if hasattr(value, "get_fields_and_field_types"):
            yield from fields(value, path)
        else:
            yield path, value


def record_message(recorder: Recorder, topic: str, message: Any) -> None:
    """Log one message seen on a ROS topic.

    A message of a single number that is not finite, which no bridge forwards, is counted but not stored as a sample.
    """
    base = f"topics/{topic.strip('/')}"
    leaves = list(fields(message, base))
    bad = [entity for entity, value in leaves if isinstance(value, float) and not math.isfinite(value)]
    recorder.scalar(f"{base}/count", 1.0)
    for entity in bad:
        recorder.scalar(f"{entity}/not_finite", 1.0)
    for entity, value in [] if bad else leaves:
        if isinstance(value, bool | int | float):
            recorder.name(entity, entity.removeprefix("topics"))
            recorder.scalar(entity, float(value))
        elif hasattr(value, "__len__") and not isinstance(value, str | bytes) and 0 < len(value) <= LONGEST_LIST:
            numbers = np.asarray(value)
            if numbers.dtype.kind in "fiu":
                recorder.array(entity, numbers)
        elif isinstance(value, str):
            recorder.said(entity, value[:LONGEST_TEXT].encode(errors="replace").decode())
    if getattr(message, "encoding", None) in PIXELS and recorder.wants_picture(base) and (picture := jpeg(message)):
        recorder.picture(base, picture)


def jpeg(image: Any) -> bytes:
    """Return a sensor_msgs/Image of a format in PIXELS as a JPEG file; empty if the picture is incomplete."""
    from PIL import Image

    mode, raw, width = PIXELS[image.encoding]
    data = bytes(image.data)
    if not (image.width and image.height and image.step >= width * image.width):
        return b""
    if len(data) < image.step * image.height:
        return b""
    picture = Image.frombytes(mode, (image.width, image.height), data, "raw", raw, image.step, 1)
    target = io.BytesIO()
    picture.save(target, "JPEG", quality=JPEG_QUALITY)
    return target.getvalue()
