"""The options and the output of the verbs that list topics or services."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

from gz_course.sim.ros2.graph import add_graph_options


def add_listing_options(parser: argparse.ArgumentParser, noun: str) -> None:
    """Add the options for names of topics or services: `count` and `hidden` in the namespace."""
    add_graph_options(parser)
    parser.add_argument(
        "-c", f"--count-{noun}s", dest="count", action="store_true", help=f"Only display the number of {noun}s"
    )
    parser.add_argument(
        f"--include-hidden-{noun}s", dest="hidden", action="store_true", help=f"Consider hidden {noun}s as well"
    )


def print_names(names: Sequence[str], count: bool) -> None:
    """Print one name per line, or only their number."""
    for line in [len(names)] if count else names:
        print(line)
