"""Action names, types, and the nodes at both ends of an action, for the verbs of `ros2 action`."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from typing import Any

from rclpy.impl.implementation_singleton import rclpy_implementation

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.ros2.graph import Graph, NamesAndTypes
from gz_course.sim.ros.ros2.node import split_name
from gz_course.sim.ros.ros2.topic import full_name


def action_name(graph: Graph, name: str) -> str:
    """Return the name with its namespace. Raises CommandError for an invalid name."""
    return full_name(graph, name, "action")


def action_types(graph: Graph, name: str) -> list[str]:
    """Return the types of an action as soon as it is found; empty if it is not."""
    return graph.wait_for(lambda: dict(graph.actions()).get(name, []))


def nearest_action(graph: Graph, name: str) -> str:
    """Return `; did you mean '/x'?` for the nearest action of the graph, or an empty text."""
    # A client, too, makes a name known; only a server publishes feedback.
    served = (action for action, _ in graph.actions() if graph.node.count_publishers(f"{action}/_action/feedback"))
    return did_you_mean(name, (action for action in served if action != name))


def nodes_with(graph: Graph, name: str, of_node: Callable[[Any, str, str], NamesAndTypes]) -> NamesAndTypes:
    """Return the nodes at one end of an action, and the types there; `of_node` lists such ends of one node."""
    found = []
    for node in graph.nodes(hidden=True):
        # A node that has ended meanwhile; for actions, rclpy has no error of its own for that.
        with contextlib.suppress(rclpy_implementation.RCLError):
            types = dict(of_node(graph.node, *split_name(node))).get(name)
            if types:
                found.append((node, sorted(types)))
    return found
