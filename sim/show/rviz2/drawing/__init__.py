"""How each ROS message type is drawn: one file a package or type, with a table `DRAWN` of types and functions.

A function takes a `Canvas`, the entity of the topic and the message. What is not in a table is plotted: its numbers.
"""

from __future__ import annotations

import functools
import importlib
import pkgutil
from collections.abc import Callable, Mapping
from typing import Any

Draw = Callable[[Any, str, Any], None]


@functools.cache
def drawn_types() -> Mapping[str, Draw]:
    """Return the function for each type, such as `sensor_msgs/msg/LaserScan`, from all files of this folder."""
    found: dict[str, Draw] = {}
    for each in pkgutil.iter_modules(__path__):
        found |= getattr(importlib.import_module(f"{__name__}.{each.name}"), "DRAWN", {})
    return found
