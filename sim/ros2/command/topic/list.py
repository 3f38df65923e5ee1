"""Output a list of available topics."""

from __future__ import annotations

import argparse
from collections.abc import Callable

from gz_course.sim.ros2.graph import Graph, add_graph_options


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What to show of each topic, and which topics."""
    add_graph_options(parser)
    parser.add_argument("-t", "--show-types", action="store_true", help="Additionally show the topic type")
    parser.add_argument(
        "-c", "--count-topics", action="store_true", help="Only display the number of topics discovered"
    )
    parser.add_argument("--include-hidden-topics", action="store_true", help="Consider hidden topics as well")
    parser.add_argument("-v", "--verbose", action="store_true", help="List full details about each topic")


def main(arguments: argparse.Namespace) -> None:
    """One topic a line, or with -v who publishes and who subscribes."""
    with Graph(arguments) as graph:
        graph.settle()
        topics = graph.topics(arguments.include_hidden_topics)
        if arguments.count_topics:
            print(len(topics))
        elif arguments.verbose:
            _print_ends(topics, "Published", "publisher", graph.node.count_publishers)
            _print_ends(topics, "Subscribed", "subscriber", graph.node.count_subscribers)
        else:
            for name, types in topics:
                print(f"{name} [{', '.join(types)}]" if arguments.show_types else name)


def _print_ends(topics: list[tuple[str, list[str]]], title: str, noun: str, count_of: Callable[[str], int]) -> None:
    print(f"{title} topics:")
    for name, types in topics:
        count = count_of(name)
        if count:
            print(f" * {name} [{', '.join(types)}] {count} {noun}{'s' if count > 1 else ''}")
    print()
