"""List all interface types available."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.interface import KINDS, chosen_kinds, interface_names
from gz_course.sim.ros.ros2.interface import add_kind_options as add_arguments  # noqa: F401


def main(arguments: argparse.Namespace) -> None:
    for kind in chosen_kinds(arguments):
        print("\n    ".join([f"{KINDS[kind]}:", *interface_names(kind)]))
