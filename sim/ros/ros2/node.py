"""Finds the node that a user has named, for `ros2 node info` and the verbs of `ros2 param`."""

from __future__ import annotations

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.graph import Graph
from gz_course.sim.ros.ros2.topic import warn


def find_node(graph: Graph, name: str, unknown: str, timeout: float | None = None) -> str:
    """Return the full name of a node as soon as it is found.

    A name without a leading / is in the root namespace. Warns if several nodes share the name. Raises CommandError
    with the sentence `unknown` if the node is not found, after `timeout` [s] if it is given.
    """
    full = name if name.startswith("/") else f"/{name}"
    count = graph.wait_for(lambda: graph.nodes(hidden=True).count(full), timeout)
    if not count:
        raise CommandError(unknown + did_you_mean(full, graph.nodes(hidden=True)))
    if count > 1:
        warn(
            f'There are {count} nodes in the graph with the exact name "{full}". '
            "You are seeing information about only one of them."
        )
    return full


def split_name(full: str) -> tuple[str, str]:
    """Return name and namespace of a full node name."""
    namespace, _, name = full.rpartition("/")
    return name, namespace or "/"
