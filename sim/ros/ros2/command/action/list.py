"""Output a list of action names."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.graph import Graph
from gz_course.sim.ros.ros2.listing import add_listing_options, add_show_types, print_all


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_listing_options(parser, "action", hidden=False)
    add_show_types(parser, "action")


def main(arguments: argparse.Namespace) -> None:
    with Graph(arguments) as graph:
        graph.settle()
        actions = graph.actions()
    print_all(arguments, actions)
