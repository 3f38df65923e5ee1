"""Output a list of available interface types within one package."""

from __future__ import annotations

import argparse

from gz_course.sim.ros2.interface import KINDS, add_kind_options, package_interfaces


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The package, and which kinds."""
    parser.add_argument("package_name", help="Name of the package (e.g. 'std_msgs')")
    add_kind_options(parser)


def main(arguments: argparse.Namespace) -> None:
    """One full name a line."""
    for kind in KINDS:
        if kind in arguments.kinds or not arguments.kinds:
            for name in package_interfaces(arguments.package_name, kind):
                print(name)
