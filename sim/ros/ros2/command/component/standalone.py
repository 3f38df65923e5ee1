"""Run a component into its own standalone container node (not here: that needs C++)."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.component import refusal


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("argv", nargs=argparse.REMAINDER, help="Ignored")


def main(arguments: argparse.Namespace) -> None:
    raise refusal("`ros2 component standalone` cannot work")
