"""Output a list of available services."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.graph import Graph
from gz_course.sim.ros.ros2.listing import add_listing_options, add_show_types, print_all


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_listing_options(parser, "service")
    add_show_types(parser, "service")


def main(arguments: argparse.Namespace) -> None:
    with Graph(arguments) as graph:
        graph.settle()
        services = graph.services(arguments.hidden)
    print_all(arguments, services)
