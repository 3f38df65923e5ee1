"""Output a list of available topics."""

from __future__ import annotations

import argparse
from collections.abc import Callable

from gz_course.sim.ros.ros2.graph import Graph, NamesAndTypes
from gz_course.sim.ros.ros2.listing import add_listing_options, add_show_types, print_all


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_listing_options(parser, "topic")
    add_show_types(parser, "topic")
    parser.add_argument("-v", "--verbose", action="store_true", help="List full details about each topic")


def main(arguments: argparse.Namespace) -> None:
    with Graph(arguments) as graph:
        graph.settle()
        topics = graph.topics(arguments.hidden)
        if arguments.verbose and not arguments.count:
            _print_ends(topics, "Published", "publisher", graph.node.count_publishers)
            _print_ends(topics, "Subscribed", "subscriber", graph.node.count_subscribers)
            return
    print_all(arguments, topics)


def _print_ends(topics: NamesAndTypes, title: str, noun: str, count_of: Callable[[str], int]) -> None:
    print(f"{title} topics:")
    for name, types in topics:
        count = count_of(name)
        if count:
            print(f" * {name} [{', '.join(types)}] {count} {noun}{'s' if count > 1 else ''}")
    print()
