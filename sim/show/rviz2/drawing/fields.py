"""The fields of a message of any type, by its own introspection, so that no ROS import is needed."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

SKIPPED_FIELDS = frozenset({"stamp"})  # time is the timeline already
MOST_HZ = 20.0
MOST_NUMBERS = 60  # of one message that are plotted


def fields(message: Any, prefix: str) -> Iterator[tuple[str, Any]]:
    """Yield the path and the value of every field that is no message itself, `PREFIX/linear/x` for example."""
    for name in message.get_fields_and_field_types():
        value = getattr(message, name)
        path = f"{prefix}/{name}"
        if name in SKIPPED_FIELDS:
            continue
        if hasattr(value, "get_fields_and_field_types"):
            yield from fields(value, path)
        else:
            yield path, value


def plot(canvas: Any, entity: str, message: Any) -> None:
    """Plot the finite numbers of a message, and log its texts."""
    if not canvas.is_due(entity, MOST_HZ):
        return
    numbers = [(path, value) for path, value in fields(message, entity) if isinstance(value, bool | int | float)]
    for path, value in numbers[:MOST_NUMBERS]:
        if math.isfinite(value):
            canvas.scalar(path, float(value))
    for path, value in fields(message, entity):
        if isinstance(value, str) and value and not path.endswith("frame_id"):
            canvas.text(path, value)
