"""Output a list of available topics of a given type."""

from __future__ import annotations

import argparse

from gz_course.sim.ros2.graph import Graph
from gz_course.sim.ros2.interface import message_class, message_type_name
from gz_course.sim.ros2.listing import add_listing_options, print_names


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_listing_options(parser, "topic")
    parser.add_argument("message_type", metavar="topic_type", help="Name of the ROS topic type to filter for")


def main(arguments: argparse.Namespace) -> None:
    wanted = message_type_name(message_class(arguments.message_type))
    with Graph(arguments) as graph:
        graph.settle()
        print_names([name for name, types in graph.topics(arguments.hidden) if wanted in types], arguments.count)
