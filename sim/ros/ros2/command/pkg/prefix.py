"""Output the prefix path of a package."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.packages import package_prefix, package_share


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("package_name", help="The package name")
    parser.add_argument("--share", action="store_true", help="Show share directory for the package")


def main(arguments: argparse.Namespace) -> None:
    print((package_share if arguments.share else package_prefix)(arguments.package_name))
