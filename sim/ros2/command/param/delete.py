"""Delete parameter."""

from __future__ import annotations

import argparse

from rcl_interfaces.msg import ParameterValue

from gz_course.sim.ros2.errors import CommandError
from gz_course.sim.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros2.node import find_node
from gz_course.sim.ros2.parameter import NodeParameters, python_value


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The node and the parameter."""
    add_graph_options(parser)
    parser.add_argument("node_name", help="Name of the ROS node")
    parser.add_argument("parameter_name", help="Name of the parameter")
    parser.add_argument("--include-hidden-nodes", action="store_true", help="Accepted: a node is named anyway")


def main(arguments: argparse.Namespace) -> None:
    """Only parameters of dynamic type can be deleted: the node says so otherwise."""
    name = arguments.parameter_name
    with Graph(arguments) as graph:
        parameters = NodeParameters(graph, find_node(graph, arguments.node_name, "Node not found"))
        if python_value(parameters.values([name])[0]) is None:
            raise parameters.not_set(name)
        deleted, reason = parameters.set(name, ParameterValue())
    after = f": {reason}" if reason else ""
    if not deleted:
        raise CommandError(f"Deleting parameter failed{after}")
    print(f"Deleted parameter successfully{after}")
