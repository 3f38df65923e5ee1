"""Output a list of packages that provide interfaces."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.interface import add_kind_options as add_arguments  # noqa: F401
from gz_course.sim.ros.ros2.interface import chosen_kinds, interface_packages, package_interfaces


def main(arguments: argparse.Namespace) -> None:
    for package in interface_packages():
        if any(package_interfaces(package, kind) for kind in chosen_kinds(arguments)):
            print(package)
