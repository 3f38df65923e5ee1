"""Print information about an action."""

from __future__ import annotations

import argparse

from rclpy.action.graph import get_action_client_names_and_types_by_node, get_action_server_names_and_types_by_node

from gz_course.sim.ros.ros2.action import action_name, action_types, nearest_action, nodes_with
from gz_course.sim.ros.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros.ros2.topic import warn


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_graph_options(parser)
    parser.add_argument("action_name", help="Name of the ROS action to get info (e.g. '/fibonacci')")
    parser.add_argument("-t", "--show-types", action="store_true", help="Additionally show the action type")
    parser.add_argument(
        "-c", "--count", action="store_true", help="Only display the number of action clients and action servers"
    )


def main(arguments: argparse.Namespace) -> None:
    """Print the nodes with clients and with servers; an unknown action has none, which is no failure in ROS 2."""
    with Graph(arguments) as graph:
        name = action_name(graph, arguments.action_name)
        known = bool(action_types(graph, name))
        graph.settle()
        ends = {
            "clients": nodes_with(graph, name, get_action_client_names_and_types_by_node),
            "servers": nodes_with(graph, name, get_action_server_names_and_types_by_node),
        }
        hint = "" if known else nearest_action(graph, name)
    print(f"Action: {arguments.action_name}")
    for noun, nodes in ends.items():
        print(f"Action {noun}: {len(nodes)}")
        for node, types in [] if arguments.count else nodes:
            print(f"    {node} [{', '.join(types)}]" if arguments.show_types else f"    {node}")
    if hint:
        warn(f"Unknown action '{arguments.action_name}'{hint}")
