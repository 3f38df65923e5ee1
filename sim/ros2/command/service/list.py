"""Output a list of available services."""

from __future__ import annotations

import argparse

from gz_course.sim.ros2.graph import Graph
from gz_course.sim.ros2.listing import add_listing_options, print_names


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_listing_options(parser, "service")
    parser.add_argument("-t", "--show-types", action="store_true", help="Additionally show the service type")


def main(arguments: argparse.Namespace) -> None:
    with Graph(arguments) as graph:
        graph.settle()
        services = graph.services(arguments.hidden)
    names = [f"{name} [{', '.join(types)}]" if arguments.show_types else name for name, types in services]
    print_names(names, arguments.count)
