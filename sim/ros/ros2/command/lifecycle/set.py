"""Trigger lifecycle state transition."""

from __future__ import annotations

import argparse
import sys

from gz_course.sim.ros.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros.ros2.lifecycle import Lifecycle


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_graph_options(parser)
    parser.add_argument("node_name", help="Name of the ROS node")
    parser.add_argument("transition", help="The lifecycle transition, by its label or its id")
    parser.add_argument("--include-hidden-nodes", action="store_true", help="Accepted: a node is named anyway")


def main(arguments: argparse.Namespace) -> int:
    """Return 0 if the node has made the transition, else 1."""
    with Graph(arguments) as graph:
        succeeded = Lifecycle(graph, arguments.node_name).change(arguments.transition)
    if succeeded:
        print("Transitioning successful")
        return 0
    print("Transitioning failed", file=sys.stderr)
    return 1
