"""From the name of a message type to its Python class.

`sensor_msgs/msg/LaserScan` (or `sensor_msgs/LaserScan`) is the class LaserScan of sensor_msgs.msg. Errors name
the nearest message that is installed, as listed in the ament index.
"""

from __future__ import annotations

import importlib
from typing import Any

from ament_index_python import get_resource, get_resources

from ros2.errors import CommandError, did_you_mean


def message_class(type_name: str) -> Any:
    """The class of a message type; CommandError if there is none of that name."""
    package, *middle, name = type_name.split("/") if "/" in type_name else ("", "", type_name)
    if package and name and middle in ([], ["msg"]):
        try:
            return getattr(importlib.import_module(f"{package}.msg"), name)
        except (ImportError, AttributeError):
            pass
    raise CommandError(f"The message type '{type_name}' is invalid" + did_you_mean(type_name, message_names()))


def message_names() -> list[str]:
    """`package/msg/Name` of every installed message, sorted."""
    names = []
    for package in get_resources("rosidl_interfaces"):
        files, _ = get_resource("rosidl_interfaces", package)
        names += [f"{package}/{line[:-4]}" for line in files.split() if line.endswith(".msg")]
    return sorted(names)
