"""Find actions from type."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros.ros2.interface import action_class, action_type_name
from gz_course.sim.ros.ros2.listing import print_those_of


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_graph_options(parser)
    parser.add_argument(
        "action_type", help="Name of the ROS action type to find (e.g. 'example_interfaces/action/Fibonacci')"
    )
    parser.add_argument(
        "-c", "--count-actions", "--count", dest="count", action="store_true", help="Only display the number of actions"
    )


def main(arguments: argparse.Namespace) -> None:
    wanted = action_type_name(action_class(arguments.action_type))
    print_those_of(arguments, wanted, Graph.actions)
