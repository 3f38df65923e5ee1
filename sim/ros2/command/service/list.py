"""Output a list of available services."""

from __future__ import annotations

import argparse

from gz_course.sim.ros2.graph import Graph, add_graph_options


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What to show of each service, and which services."""
    add_graph_options(parser)
    parser.add_argument("-t", "--show-types", action="store_true", help="Additionally show the service type")
    parser.add_argument(
        "-c", "--count-services", action="store_true", help="Only display the number of services discovered"
    )
    parser.add_argument("--include-hidden-services", action="store_true", help="Consider hidden services as well")


def main(arguments: argparse.Namespace) -> None:
    """One service a line, sorted."""
    with Graph(arguments) as graph:
        graph.settle()
        services = graph.services(arguments.include_hidden_services)
    if arguments.count_services:
        print(len(services))
        return
    for name, types in services:
        print(f"{name} [{', '.join(types)}]" if arguments.show_types else name)
