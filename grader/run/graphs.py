"""Both graphs of a run as facts for its recording: who publishes what, as which type, in Gazebo and in ROS.

Taken by `stage.py` at the end of a run whose submission is about the graphs (a table, a bridge); checks compare with
them.
"""

from __future__ import annotations

from typing import Any

from grader.run.ears import NODE, Ears
from gz.transport import MessagePublisher, Node

SIMULATOR = "gz sim"
WHO = (SIMULATOR, NODE)  # the two Gazebo nodes of a stage


def both_graphs(gz_nodes: list[Node], ears: Ears) -> dict[str, Any]:
    """Return the facts `gz_topics`, `ros_topics` and `bridges`. `gz_nodes` are the simulator's and the bridge's."""
    return {
        "given": True,
        "gz_topics": gz_graph(gz_nodes),
        "ros_topics": ears.ros_graph(),
        "bridges": ears.bridged(),
    }


def gz_graph(gz_nodes: list[Node]) -> dict[str, dict[str, list[str]]]:
    """Return Gazebo's graph: topic -> types, publishing and subscribing programs."""
    published, subscribed = gz_nodes[0].publishers_and_subscribers()
    advertised = {who: set(node.advertised_topics()) for who, node in zip(WHO, gz_nodes, strict=True)}
    heard = {who: set(node.subscribed_topics()) for who, node in zip(WHO, gz_nodes, strict=True)}
    return {
        topic: {
            "types": _types(topic, published) or _types(topic, subscribed),
            "publishers": [who for who in WHO if topic in advertised[who]],
            "subscribers": [who for who in WHO if topic in heard[who]],
        }
        for topic in sorted({end.topic for end in [*published, *subscribed]})
    }


def _types(topic: str, ends: list[MessagePublisher]) -> list[str]:
    return sorted({end.msg_type_name for end in ends if end.topic == topic})
