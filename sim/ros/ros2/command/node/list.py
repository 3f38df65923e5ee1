"""Output a list of available nodes."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros.ros2.listing import print_names
from gz_course.sim.ros.ros2.topic import warn


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_graph_options(parser)
    parser.add_argument("-a", "--all", action="store_true", help="Display all nodes even hidden ones")
    parser.add_argument("-c", "--count-nodes", action="store_true", help="Only display the number of nodes discovered")


def main(arguments: argparse.Namespace) -> None:
    with Graph(arguments) as graph:
        graph.settle()
        names = graph.nodes(hidden=arguments.all)
    print_names(names, arguments.count_nodes)
    if len(set(names)) < len(names) and not arguments.count_nodes:
        warn(
            "\nWARNING: Be aware that there are nodes in the graph that share an exact name, which can have "
            "unintended side effects."
        )
