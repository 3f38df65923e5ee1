"""Output a list of available interface types within one package."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.interface import add_kind_options, chosen_kinds, package_interfaces


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("package_name", help="Name of the package (e.g. 'std_msgs')")
    add_kind_options(parser)


def main(arguments: argparse.Namespace) -> None:
    for kind in chosen_kinds(arguments):
        for name in package_interfaces(arguments.package_name, kind):
            print(name)
