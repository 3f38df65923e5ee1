"""Output a list of available topics of a given type."""

from __future__ import annotations

import argparse

from gz_course.sim.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros2.interface import message_class, message_type_name


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The type, and which topics."""
    add_graph_options(parser)
    parser.add_argument("message_type", metavar="topic_type", help="Name of the ROS topic type to filter for")
    parser.add_argument(
        "-c", "--count-topics", action="store_true", help="Only display the number of topics discovered"
    )
    parser.add_argument("--include-hidden-topics", action="store_true", help="Consider hidden topics as well")


def main(arguments: argparse.Namespace) -> None:
    """One topic a line, sorted."""
    wanted = message_type_name(message_class(arguments.message_type))
    with Graph(arguments) as graph:
        graph.settle()
        names = [name for name, types in graph.topics(arguments.include_hidden_topics) if wanted in types]
    print(len(names) if arguments.count_topics else "\n".join(names), end="" if not names else "\n")
