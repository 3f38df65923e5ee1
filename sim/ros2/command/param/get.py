"""Get parameter."""

from __future__ import annotations

import argparse

from gz_course.sim.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros2.node import find_node
from gz_course.sim.ros2.parameter import NodeParameters, kind_word, python_value


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The node and the parameter."""
    add_graph_options(parser)
    parser.add_argument("node_name", help="Name of the ROS node")
    parser.add_argument("parameter_name", help="Name of the parameter")
    parser.add_argument("--include-hidden-nodes", action="store_true", help="Accepted: a node is named anyway")
    parser.add_argument("--hide-type", action="store_true", help="Hide the type information")


def main(arguments: argparse.Namespace) -> None:
    """Kind and value; CommandError for a parameter that is not set."""
    with Graph(arguments) as graph:
        parameters = NodeParameters(graph, find_node(graph, arguments.node_name, "Node not found"))
        value = parameters.values([arguments.parameter_name])[0]
        shown = python_value(value)
        if shown is None:
            raise parameters.not_set(arguments.parameter_name)
    print(shown if arguments.hide_type else f"{kind_word(value)} {shown}")
