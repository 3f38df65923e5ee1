"""Output a list of components registered in the ament index."""

from __future__ import annotations

import argparse

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.ros2.component import packages_with_components, registered
from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.packages import package_names


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("package_name", nargs="?", help="Optional package name to narrow down the list")


def main(arguments: argparse.Namespace) -> None:
    package = arguments.package_name
    if package is None:
        for name in packages_with_components():
            print(name, *(f"  {each}" for each in registered(name)), sep="\n")
        return
    known = package_names()
    if package not in known:
        raise CommandError(f"Unable to find package '{package}'{did_you_mean(package, known)}")
    for each in registered(package):
        print(each)
