"""Output information about a node."""

from __future__ import annotations

import argparse

from rclpy.action.graph import (
    get_action_client_names_and_types_by_node,
    get_action_server_names_and_types_by_node,
)
from rclpy.impl.implementation_singleton import rclpy_implementation

from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.graph import Graph, NamesAndTypes, add_graph_options, is_hidden
from gz_course.sim.ros.ros2.node import find_node, split_name


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_graph_options(parser)
    parser.add_argument("node_name", help="Node name to request information")
    parser.add_argument(
        "--include-hidden", action="store_true", help="Display hidden topics, services, and actions as well"
    )


def main(arguments: argparse.Namespace) -> None:
    with Graph(arguments) as graph:
        full = find_node(graph, arguments.node_name, f"Unable to find node '{arguments.node_name}'")
        graph.settle()
        name, namespace = split_name(full)
        node = graph.node
        try:
            sections: dict[str, NamesAndTypes] = {
                "Subscribers": node.get_subscriber_names_and_types_by_node(name, namespace),
                "Publishers": node.get_publisher_names_and_types_by_node(name, namespace),
                "Service Servers": node.get_service_names_and_types_by_node(name, namespace),
                "Service Clients": node.get_client_names_and_types_by_node(name, namespace),
                "Action Servers": get_action_server_names_and_types_by_node(node, name, namespace),
                "Action Clients": get_action_client_names_and_types_by_node(node, name, namespace),
            }
        except rclpy_implementation.RCLError:
            raise CommandError(f"The node '{full}' ended while it was looked at") from None
    print(full)
    for title, found in sections.items():
        print(f"  {title}:")
        shown = sorted(entry for entry in found if arguments.include_hidden or not is_hidden(entry[0]))
        print("\n".join(f"    {name}: {', '.join(types)}" for name, types in shown))
