"""Output a list of services of a given type."""

from __future__ import annotations

import argparse

from gz_course.sim.ros2.graph import Graph
from gz_course.sim.ros2.interface import service_class, service_type_name
from gz_course.sim.ros2.listing import add_listing_options, print_names


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_listing_options(parser, "service")
    parser.add_argument("service_type", help="Name of the ROS service type to filter for (e.g. 'std_srvs/srv/Empty')")


def main(arguments: argparse.Namespace) -> None:
    wanted = service_type_name(service_class(arguments.service_type))
    with Graph(arguments) as graph:
        graph.settle()
        print_names([name for name, types in graph.services(arguments.hidden) if wanted in types], arguments.count)
