"""Print a topic's type."""

from __future__ import annotations

import argparse

from gz_course.sim.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros2.topic import nearest_topic, warn


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_graph_options(parser)
    parser.add_argument("topic_name", help="Name of the ROS topic to get type (e.g. '/chatter')")


def main(arguments: argparse.Namespace) -> int:
    """Return 1, and print nothing to stdout, for an unknown topic."""
    with Graph(arguments) as graph:
        types = graph.wait_for_topic(arguments.topic_name)
        for name in types:
            print(name)
        if not types and (hint := nearest_topic(graph, arguments.topic_name)):
            warn(f"Unknown topic '{arguments.topic_name}'{hint}")
        return 0 if types else 1
