"""The verbs that list names, find them by their type, or print their type: of topics, services and actions alike."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence

from gz_course.sim.ros.ros2.graph import Graph, NamesAndTypes, add_graph_options
from gz_course.sim.ros.ros2.topic import warn


def add_listing_options(parser: argparse.ArgumentParser, noun: str, *, hidden: bool = True) -> None:
    """Add the options for names of topics, services or actions: `count`, and `hidden` if they have hidden ones."""
    add_graph_options(parser)
    parser.add_argument(
        "-c", f"--count-{noun}s", dest="count", action="store_true", help=f"Only display the number of {noun}s"
    )
    if hidden:
        parser.add_argument(
            f"--include-hidden-{noun}s", dest="hidden", action="store_true", help=f"Consider hidden {noun}s as well"
        )


def add_show_types(parser: argparse.ArgumentParser, noun: str) -> None:
    """Add the option `show_types`."""
    parser.add_argument("-t", "--show-types", action="store_true", help=f"Additionally show the {noun} type")


def print_names(names: Sequence[str], count: bool) -> None:
    """Print one name per line, or only their number."""
    for line in [len(names)] if count else names:
        print(line)


def print_all(arguments: argparse.Namespace, found: NamesAndTypes) -> None:
    """Print the names, with their types if that is asked for, or their number."""
    names = [f"{name} [{', '.join(types)}]" if arguments.show_types else name for name, types in found]
    print_names(names, arguments.count)


def print_those_of(
    arguments: argparse.Namespace, wanted: str, names_and_types: Callable[[Graph], NamesAndTypes]
) -> None:
    """Print the names that have the type `wanted`, or their number."""
    with Graph(arguments) as graph:
        graph.settle()
        print_names([name for name, types in names_and_types(graph) if wanted in types], arguments.count)


def print_types(noun: str, given: str, types: Sequence[str], hint: Callable[[], str]) -> int:
    """Print one type per line; for an unknown name return 1, with the `hint` on stderr."""
    for kind in types:
        print(kind)
    if not types and (nearest := hint()):
        warn(f"Unknown {noun} '{given}'{nearest}")
    return 0 if types else 1
