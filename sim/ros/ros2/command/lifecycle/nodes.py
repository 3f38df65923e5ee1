"""Output a list of nodes with lifecycle."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros.ros2.lifecycle import lifecycle_nodes
from gz_course.sim.ros.ros2.listing import print_names


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_graph_options(parser)
    parser.add_argument("-a", "--all", action="store_true", help="Display all nodes even hidden ones")
    parser.add_argument("-c", "--count-nodes", action="store_true", help="Only display the number of nodes discovered")


def main(arguments: argparse.Namespace) -> None:
    with Graph(arguments) as graph:
        graph.settle()
        print_names(lifecycle_nodes(graph, hidden=arguments.all), arguments.count_nodes)
