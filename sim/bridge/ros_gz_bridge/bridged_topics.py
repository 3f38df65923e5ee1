"""The ROS parameter that lists what a running bridge bridges: `ros2 param get /ros_gz_bridge bridged_topics`.

Each text is a JSON object with the keys of the configuration file; topics are those after remapping.
`parameter_bridge` sets it, and tools that inspect the graph read it with `entries`.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import TYPE_CHECKING

from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry, Direction

if TYPE_CHECKING:
    from rclpy.node import Node

PARAMETER = "bridged_topics"
_TOPICS_AND_TYPES = ("ros_topic_name", "gz_topic_name", "ros_type_name", "gz_type_name")


def offer(node: Node, entries: Iterable[BridgeEntry]) -> None:
    """Set the parameter on the bridge's node, replacing an earlier value."""
    from rclpy.parameter import Parameter

    texts = [_text(entry, node.resolve_topic_name(entry.ros_topic)) for entry in entries]
    offered = Parameter(PARAMETER, Parameter.Type.STRING_ARRAY, texts)
    if not node.has_parameter(PARAMETER):
        node.declare_parameter(PARAMETER, Parameter.Type.STRING_ARRAY)
    node.set_parameters([offered])


def entries(texts: Iterable[str]) -> list[BridgeEntry]:
    """Return the entries of the parameter's value. Raises ValueError for a text that is no entry."""
    found = []
    for text in texts:
        try:
            keys = json.loads(text)
            ros_topic, gz_topic, ros_type, gz_type = names = [keys[name] for name in _TOPICS_AND_TYPES]
            direction, lazy = Direction(keys["direction"]), bool(keys["lazy"])
        except (KeyError, TypeError, ValueError) as error:
            raise ValueError(f"{text[:80]!r} is no entry of a bridge: {error}") from None
        if not all(isinstance(name, str) for name in names):
            raise ValueError(f"{text[:80]!r} is no entry of a bridge: names and types are texts")
        found.append(BridgeEntry(ros_topic, gz_topic, ros_type, gz_type, direction=direction, lazy=lazy))
    return found


def _text(entry: BridgeEntry, ros_topic: str) -> str:
    names = (ros_topic, entry.gz_topic, entry.ros_type, entry.gz_type)
    keys = dict(zip(_TOPICS_AND_TYPES, names, strict=True))
    return json.dumps({**keys, "direction": entry.direction.value, "lazy": entry.lazy})
