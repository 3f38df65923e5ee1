"""Output a list of services of a given type."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.interface import service_class, service_type_name
from gz_course.sim.ros.ros2.listing import add_listing_options, print_those_of


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_listing_options(parser, "service")
    parser.add_argument("service_type", help="Name of the ROS service type to filter for (e.g. 'std_srvs/srv/Empty')")


def main(arguments: argparse.Namespace) -> None:
    wanted = service_type_name(service_class(arguments.service_type))
    print_those_of(arguments, wanted, lambda graph: graph.services(arguments.hidden))
