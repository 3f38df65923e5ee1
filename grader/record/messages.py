"""Turns a ROS message into rows of the recording, whatever its type.

Every numeric field becomes a signal named after it: `topics/cmd_vel/linear/x`. Lists of numbers become one list a
row. Knows ROS messages only by their own introspection, so it needs no ROS import.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from grader.record.recorder import Recorder

LONGEST_LIST = 20_000  # numbers; images and clouds are shown, not stored number by number
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
