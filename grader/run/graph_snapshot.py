"""Both graphs of a run as facts for its recording: topics, types, publishers and subscribers in Gazebo and ROS.

`run_loop.py` takes them at the end of a run whose submission is about the graphs (a table, a bridge); checks compare
the submission with them.
"""

from __future__ import annotations

from typing import Any

from gz_course.grader.run.fair_clock import FairClock
from gz_course.grader.run.grader_endpoints import NODE, GraderEndpoints
from gz_course.sim.gz.transport import MessagePublisher, Node

SIMULATOR = "gz sim"


def both_graphs(gz_node: Node, ros: GraderEndpoints, clock: FairClock) -> dict[str, Any]:
    """Return the facts `gz_topics`, `ros_topics` and `bridges`. `gz_node` is the bridge's, `clock` that of the run."""
    return {
        "gz_topics": gz_graph(gz_node),
        "ros_topics": ros.ros_graph(clock),
        "bridges": ros.bridged(),
    }


def gz_graph(gz_node: Node) -> dict[str, dict[str, list[str]]]:
    """Return Gazebo's graph, seen from the bridge's node: topic -> types, publishing and subscribing programs."""
    published, subscribed = gz_node.publishers_and_subscribers()
    own = set(gz_node.advertised_topics()), set(gz_node.subscribed_topics())
    return {
        topic: {
            "types": _types(topic, published) or _types(topic, subscribed),
            "publishers": _who(topic, published, own[0]),
            "subscribers": _who(topic, subscribed, own[1]),
        }
        for topic in sorted({end.topic for end in [*published, *subscribed]})
    }


def _types(topic: str, ends: list[MessagePublisher]) -> list[str]:
    return sorted({end.msg_type_name for end in ends if end.topic == topic})


def _who(topic: str, ends: list[MessagePublisher], own: set[str]) -> list[str]:
    """Return the programs at the ends of a Gazebo topic: the bridge for its `own`, the simulator otherwise."""
    others = sum(end.topic == topic for end in ends) > (topic in own)
    return [SIMULATOR] * others + [NODE] * (topic in own)
