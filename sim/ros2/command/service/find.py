"""Output a list of services of a given type."""

from __future__ import annotations

import argparse

from gz_course.sim.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros2.interface import service_class, service_type_name


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The type, and which services."""
    add_graph_options(parser)
    parser.add_argument("service_type", help="Name of the ROS service type to filter for (e.g. 'std_srvs/srv/Empty')")
    parser.add_argument(
        "-c", "--count-services", action="store_true", help="Only display the number of services discovered"
    )
    parser.add_argument("--include-hidden-services", action="store_true", help="Consider hidden services as well")


def main(arguments: argparse.Namespace) -> None:
    """One service a line, sorted."""
    wanted = service_type_name(service_class(arguments.service_type))
    with Graph(arguments) as graph:
        graph.settle()
        names = [name for name, types in graph.services(arguments.include_hidden_services) if wanted in types]
    if arguments.count_services:
        print(len(names))
        return
    for name in names:
        print(name)
