"""The rows of a recording that a ROS message of any type becomes.

Every numeric field becomes a signal named after it: `topics/cmd_vel/linear/x`. Lists of numbers become one list a
row, texts a line whenever they change, and pictures a JPEG now and then. Knows ROS messages only by their own
introspection, so it needs no ROS import.
"""

from __future__ import annotations

import io
import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from gz_course.grader.record.recorder import Recorder

LONGEST_LIST = 20_000  # numbers; images and clouds are shown, not stored number by number
LONGEST_TEXT = 2_000  # characters of a text that are kept
JPEG_QUALITY = 85
# ROS's names of the pixel formats a picture is made of: Pillow's mode, its raw mode, bytes a pixel.
PIXELS = {"rgb8": ("RGB", "RGB", 3), "bgr8": ("RGB", "BGR", 3), "mono8": ("L", "L", 1)}
SKIPPED_FIELDS = frozenset({"stamp"})  # simulated time is the timeline already


def fields(message: Any, prefix: str) -> Iterator[tuple[str, Any]]:
    """Yield (name, value) of every leaf field of a ROS message."""
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

    A message with a single number that is not finite, which no bridge lets through, is counted and not drawn.
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
    """Return a sensor_msgs/Image of one of the formats in PIXELS as a JPEG file; empty if it is not a whole picture."""
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
