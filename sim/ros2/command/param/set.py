"""Set parameter."""

from __future__ import annotations

import argparse

from gz_course.sim.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros2.node import find_node
from gz_course.sim.ros2.parameter import NodeParameters, value_from_yaml
from gz_course.sim.ros2.topic import warn


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The node, the parameter and its value."""
    add_graph_options(parser)
    parser.add_argument("node_name", help="Name of the ROS node")
    parser.add_argument("parameter_name", help="Name of the parameter")
    parser.add_argument("value", help="Value of the parameter in YAML format")
    parser.add_argument("--include-hidden-nodes", action="store_true", help="Accepted: a node is named anyway")
    parser.add_argument("--strict", action="store_true", help="Exit code 1 if the node refuses the value (default: 0)")


def main(arguments: argparse.Namespace) -> int:
    """Whether the node has taken it; a refusal is told on stderr."""
    value = value_from_yaml(arguments.value)
    with Graph(arguments) as graph:
        parameters = NodeParameters(graph, find_node(graph, arguments.node_name, "Node not found"))
        taken, reason = parameters.set(arguments.parameter_name, value)
    after = f": {reason}" if reason else ""
    if taken:
        print(f"Set parameter successful{after}")
        return 0
    warn(f"Setting parameter failed{after}")
    return 1 if arguments.strict else 0
