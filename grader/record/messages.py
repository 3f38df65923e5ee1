"""The rows of a recording that a ROS message of any type becomes.

Every numeric field becomes a signal named after it: `topics/cmd_vel/linear/x`. A list of numbers becomes one row, a
text or a list of texts (as JSON) a line whenever it changes, and a picture now and then a JPEG. A list of messages, as
that of the transforms of `/tf`, becomes a row of all its numbers and a line of all its texts, one of each per message.
The transforms of /tf and /tf_static become signals named after their frames, too:
`topics/tf_static/base_link/lidar_link/translation/x`. The stamp of a header is one number, `topics/scan/header/stamp`
[s]. Messages are read by their own introspection, so no ROS import is needed.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator
from typing import Any

import numpy as np

from gz_course.grader.record.recorder import Recorder
from gz_course.sim.show.rviz2.drawing.fields import fields
from gz_course.sim.show.rviz2.drawing.image import jpeg

LONGEST_LIST = 20_000  # numbers; longer lists, such as images and clouds, are not stored as numbers
MOST_TRANSFORMS = 100  # of one message
NOT_IN_NAMES = re.compile(r"[^A-Za-z0-9_-]")
LONGEST_TEXT = 2_000  # characters kept of a text
LONGEST_TEXTS = 4_000  # characters of a list of texts; longer ones are not kept
EACH = "each"  # the entity below a list of messages
NOT_KEPT = "null"  # the line of a list that is not kept
# Of the pictures that can be drawn, those of which JPEG keeps what they show.
RECORDED = frozenset({"rgb8", "bgr8", "mono8"})


def record_message(recorder: Recorder, topic: str, message: Any) -> None:
    """Log one message seen on a ROS topic.

    A message of a single number that is not finite, which no bridge forwards, is counted but not stored as a sample.
    """
    base = f"topics/{topic.strip('/')}"
    leaves = [*fields(message, base), *_transforms(message, base)]
    bad = [entity for entity, value in leaves if isinstance(value, float) and not math.isfinite(value)]
    recorder.typed(base, f"{type(message).__module__.partition('.')[0]}/msg/{type(message).__name__}")
    recorder.scalar(f"{base}/count", 1.0)
    for entity in bad:
        recorder.scalar(f"{entity}/not_finite", 1.0)
    for entity, value in [] if bad else leaves:
        if isinstance(value, bool | int | float):
            recorder.name(entity, entity.removeprefix("topics"))
            recorder.scalar(entity, float(value))
        elif isinstance(value, list):
            _list(recorder, entity, value)
        elif hasattr(value, "__len__") and not isinstance(value, str | bytes) and 0 < len(value) <= LONGEST_LIST:
            numbers = np.asarray(value)
            if numbers.dtype.kind in "fiu":
                recorder.array(entity, numbers)
        elif isinstance(value, str):
            recorder.said(entity, value[:LONGEST_TEXT].encode(errors="replace").decode())
    stamp = getattr(getattr(message, "header", None), "stamp", None)
    if stamp is not None and not bad:
        recorder.scalar(f"{base}/header/stamp", stamp.sec + stamp.nanosec / 1e9)
    if getattr(message, "encoding", None) in RECORDED and recorder.wants_picture(base) and (picture := jpeg(message)):
        recorder.picture(base, picture)


def _list(recorder: Recorder, entity: str, values: list[Any]) -> None:
    """Log a list of texts; log a list of messages below `EACH`, if they hold nothing but numbers and texts.

    An empty list could be either, so it is logged as both.
    """
    if all(isinstance(value, str) for value in values):
        text = json.dumps(values)
        recorder.said(entity, text if len(text) <= LONGEST_TEXTS else NOT_KEPT)
    if not all(hasattr(value, "get_fields_and_field_types") for value in values):
        return
    parts = [[leaf for _, leaf in fields(value, "")] for value in values]
    text = json.dumps([[leaf for leaf in part if isinstance(leaf, str)] for part in parts])
    numbers = [float(leaf) for part in parts for leaf in part if isinstance(leaf, bool | int | float)]
    whole = all(isinstance(leaf, bool | int | float | str) for part in parts for leaf in part)
    if not whole or len(text) > LONGEST_TEXTS or len(numbers) > LONGEST_LIST:
        recorder.text(f"{entity}/{EACH}", NOT_KEPT)
        return
    recorder.text(f"{entity}/{EACH}", text)
    if numbers:
        recorder.array(f"{entity}/{EACH}", numbers)


def _transforms(message: Any, base: str) -> Iterator[tuple[str, Any]]:
    """Yield the numbers of the transforms in a tf2_msgs/msg/TFMessage, with the frames in their names."""
    for each in getattr(message, "transforms", [])[:MOST_TRANSFORMS]:
        parent, child = (NOT_IN_NAMES.sub("_", frame) or "_" for frame in (each.header.frame_id, each.child_frame_id))
        yield from fields(each.transform, f"{base}/{parent}/{child}")
