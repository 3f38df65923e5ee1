"""Various rosbag related sub-commands (none here: the course records its runs itself)."""

from __future__ import annotations

import argparse

from gz_course.sim.ros2.errors import CommandError


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("argv", nargs=argparse.REMAINDER, help="Ignored")


def main(arguments: argparse.Namespace) -> None:
    raise CommandError(
        "There are no bags here: every graded run is recorded as an .rrd file next to its report; "
        "look at it with `course show RECORDING`"
    )
