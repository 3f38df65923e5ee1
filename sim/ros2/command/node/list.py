"""Output a list of available nodes."""

from __future__ import annotations

import argparse

from gz_course.sim.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros2.topic import warn


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Which nodes, or how many."""
    add_graph_options(parser)
    parser.add_argument("-a", "--all", action="store_true", help="Display all nodes even hidden ones")
    parser.add_argument("-c", "--count-nodes", action="store_true", help="Only display the number of nodes discovered")


def main(arguments: argparse.Namespace) -> None:
    """One full name a line, sorted."""
    with Graph(arguments) as graph:
        graph.settle()
        names = graph.nodes(hidden=arguments.all)
    if arguments.count_nodes:
        print(len(names))
        return
    for name in names:
        print(name)
    if len(set(names)) < len(names):
        warn(
            "\nWARNING: Be aware that there are nodes in the graph that share an exact name, which can have "
            "unintended side effects."
        )
