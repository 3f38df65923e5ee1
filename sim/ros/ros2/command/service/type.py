"""Output a service's type."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros.ros2.listing import print_types
from gz_course.sim.ros.ros2.service import nearest_service, service_name, service_types


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_graph_options(parser)
    parser.add_argument("service_name", help="Name of the ROS service to get type (e.g. '/spawn')")


def main(arguments: argparse.Namespace) -> int:
    """Return 1, and print nothing to stdout, for an unknown service."""
    with Graph(arguments) as graph:
        name = service_name(graph, arguments.service_name)
        types = service_types(graph, name)
        return print_types("service", arguments.service_name, types, lambda: nearest_service(graph, name))
