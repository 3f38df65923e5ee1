"""The daemon (there is none here: every command looks at the graph itself)."""

from __future__ import annotations

import argparse


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "verb", nargs="?", choices=["start", "status", "stop"], default="status", help="Default: status"
    )
    parser.add_argument("--debug", action="store_true", help="Accepted and ignored")


def main(arguments: argparse.Namespace) -> None:
    """Report that no daemon runs, and none is needed: with exit code 0, because scripts start one first."""
    if arguments.verb == "start":
        print("No daemon is needed: every command looks at the graph itself")
    else:
        print("The daemon is not running")
