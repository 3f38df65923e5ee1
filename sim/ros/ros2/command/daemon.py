"""The daemon (there is none here: every command looks at the graph itself)."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.errors import CommandError


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "verb", nargs="?", choices=["start", "status", "stop"], default="status", help="Default: status"
    )
    parser.add_argument("--debug", action="store_true", help="Accepted and ignored")


def main(arguments: argparse.Namespace) -> None:
    """Report that no daemon runs, which scripts check."""
    if arguments.verb == "start":
        raise CommandError("There is no daemon to start: every command looks at the graph itself")
    print("The daemon is not running")
