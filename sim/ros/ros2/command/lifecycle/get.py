"""Get lifecycle state for one or more nodes."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros.ros2.lifecycle import Lifecycle, lifecycle_nodes


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_graph_options(parser)
    parser.add_argument("node_name", nargs="?", help="Name of the ROS node (default: every lifecycle node)")
    parser.add_argument("--include-hidden-nodes", action="store_true", help="Consider hidden nodes as well")


def main(arguments: argparse.Namespace) -> None:
    with Graph(arguments) as graph:
        if arguments.node_name:
            print(Lifecycle(graph, arguments.node_name).state())
            return
        graph.settle()
        for name in lifecycle_nodes(graph, hidden=arguments.include_hidden_nodes):
            print(f"{name}: {Lifecycle(graph, name).state()}")
