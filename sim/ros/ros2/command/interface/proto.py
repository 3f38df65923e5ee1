"""Output an interface prototype."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.interface import add_interface_type, prototype
from gz_course.sim.ros.ros2.message_text import TextFormat, to_yaml


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_interface_type(parser)
    parser.add_argument("--no-quotes", action="store_true", help="If true, output has no outer quotes")


def main(arguments: argparse.Namespace) -> None:
    """Print the YAML of a message with default values, to be edited and passed to `ros2 topic pub`."""
    text = to_yaml(prototype(arguments.type), TextFormat(limit=None))
    print(text if arguments.no_quotes else f'"{text}"\n', end="")
