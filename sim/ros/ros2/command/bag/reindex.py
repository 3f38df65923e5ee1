"""Reconstruct metadata file for a bag."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.bag import add_bag_path, bag_errors
from gz_course.sim.ros.rosbag2.storage.bag import reindex


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_bag_path(parser)


def main(arguments: argparse.Namespace) -> None:
    with bag_errors():
        metadata = reindex(arguments.bag_path)
    print(f"Reindexing complete: {metadata.count} messages in {len(metadata.files)} file(s).")
