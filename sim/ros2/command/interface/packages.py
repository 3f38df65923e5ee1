"""Output a list of packages that provide interfaces."""

from __future__ import annotations

import argparse

from gz_course.sim.ros2.interface import KINDS, add_kind_options, interface_packages, package_interfaces


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Which kinds."""
    add_kind_options(parser)


def main(arguments: argparse.Namespace) -> None:
    """One package a line, sorted."""
    for package in interface_packages():
        if any(package_interfaces(package, kind) for kind in arguments.kinds or KINDS):
            print(package)
