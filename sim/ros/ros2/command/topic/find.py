"""Output a list of available topics of a given type."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.interface import message_class, message_type_name
from gz_course.sim.ros.ros2.listing import add_listing_options, print_those_of


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_listing_options(parser, "topic")
    parser.add_argument("message_type", metavar="topic_type", help="Name of the ROS topic type to filter for")


def main(arguments: argparse.Namespace) -> None:
    wanted = message_type_name(message_class(arguments.message_type))
    print_those_of(arguments, wanted, lambda graph: graph.topics(arguments.hidden))
