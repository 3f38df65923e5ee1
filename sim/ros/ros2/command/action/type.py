"""Print an action's type."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.action import action_name, action_types, nearest_action
from gz_course.sim.ros.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros.ros2.listing import print_types


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_graph_options(parser)
    parser.add_argument("action_name", help="Name of the ROS action to get type (e.g. '/fibonacci')")


def main(arguments: argparse.Namespace) -> int:
    """Return 1, and print nothing to stdout, for an unknown action."""
    with Graph(arguments) as graph:
        name = action_name(graph, arguments.action_name)
        types = action_types(graph, name)
        return print_types("action", arguments.action_name, types, lambda: nearest_action(graph, name))
