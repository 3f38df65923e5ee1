"""Print a topic's type."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros.ros2.listing import print_types
from gz_course.sim.ros.ros2.topic import nearest_topic


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_graph_options(parser)
    parser.add_argument("topic_name", help="Name of the ROS topic to get type (e.g. '/chatter')")


def main(arguments: argparse.Namespace) -> int:
    """Return 1, and print nothing to stdout, for an unknown topic."""
    with Graph(arguments) as graph:
        name = arguments.topic_name
        return print_types("topic", name, graph.wait_for_topic(name), lambda: nearest_topic(graph, name))
