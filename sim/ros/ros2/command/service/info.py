"""Print information about a service."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros.ros2.service import nearest_service, service_name, service_types


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_graph_options(parser)
    parser.add_argument("service_name", help="Name of the ROS service to get info (e.g. '/talker/get_parameters')")


def main(arguments: argparse.Namespace) -> None:
    with Graph(arguments) as graph:
        name = service_name(graph, arguments.service_name)
        types = service_types(graph, name)
        if not types:
            raise CommandError(f"Unknown service '{arguments.service_name}'{nearest_service(graph, name)}")
        graph.settle()
        print(f"Type: {types[0] if len(types) == 1 else types}")
        print(f"Clients count: {graph.node.count_clients(name)}")
        print(f"Services count: {graph.node.count_services(name)}")
