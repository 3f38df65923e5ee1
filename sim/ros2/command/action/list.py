"""Output a list of action names."""

from __future__ import annotations

import argparse

from gz_course.sim.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros2.listing import print_names


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_graph_options(parser)
    parser.add_argument("-t", "--show-types", action="store_true", help="Additionally show the action type")
    parser.add_argument("-c", "--count-actions", action="store_true", help="Only display the number of actions")


def main(arguments: argparse.Namespace) -> None:
    with Graph(arguments) as graph:
        graph.settle()
        actions = graph.actions()
    names = [f"{name} [{', '.join(types)}]" if arguments.show_types else name for name, types in actions]
    print_names(names, arguments.count_actions)
