"""Output a list of available packages."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.packages import package_names


def add_arguments(parser: argparse.ArgumentParser) -> None:
    pass


def main(arguments: argparse.Namespace) -> None:
    print("\n".join(package_names()))
