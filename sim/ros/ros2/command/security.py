"""Various security related sub-commands (none here: DDS is not built with security)."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.errors import CommandError


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("argv", nargs=argparse.REMAINDER, help="Ignored")


def main(arguments: argparse.Namespace) -> None:
    raise CommandError(
        "There are no keystores and enclaves here, because this Fast DDS has no security: make them with sros2 on a "
        "full installation; here, ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST keeps other machines out"
    )
