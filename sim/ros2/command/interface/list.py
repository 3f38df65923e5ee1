"""List all interface types available."""

from __future__ import annotations

import argparse

from gz_course.sim.ros2.interface import KINDS, add_kind_options, interface_names


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Which kinds."""
    add_kind_options(parser)


def main(arguments: argparse.Namespace) -> None:
    """A heading for each kind, below it the names."""
    for kind, heading in KINDS.items():
        if kind in arguments.kinds or not arguments.kinds:
            print(f"{heading}:")
            for name in interface_names(kind):
                print(f"    {name}")
