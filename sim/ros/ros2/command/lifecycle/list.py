"""Output a list of available transitions."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros.ros2.lifecycle import Lifecycle


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_graph_options(parser)
    parser.add_argument("node_name", help="Name of the ROS node")
    parser.add_argument("-a", "--all", action="store_true", help="Display all existing transitions")
    parser.add_argument("--include-hidden-nodes", action="store_true", help="Accepted: a node is named anyway")


def main(arguments: argparse.Namespace) -> None:
    with Graph(arguments) as graph:
        for each in Lifecycle(graph, arguments.node_name).transitions(every=arguments.all):
            print(f"- {each.transition.label} [{each.transition.id}]")
            print(f"\tStart: {each.start_state.label}\n\tGoal: {each.goal_state.label}")
