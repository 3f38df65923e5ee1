"""Print information about a bag to the screen."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.bag import add_bag_path, bag_errors, opened
from gz_course.sim.ros.rosbag2.selection import SERVICE_EVENTS
from gz_course.sim.ros.rosbag2.summary import summary


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_bag_path(parser)
    parser.add_argument("-t", "--topic-name", action="store_true", help="Only display topic names")
    parser.add_argument("-v", "--verbose", action="store_true", help="Also display each file and the types' hashes")


def main(arguments: argparse.Namespace) -> None:
    with bag_errors():
        bag = opened(arguments.bag_path)
        if arguments.topic_name:
            names = sorted(topic.name for topic in bag.metadata.topics if not topic.name.endswith(SERVICE_EVENTS))
            print("\n".join(names))
        else:
            print(summary(bag.metadata, bag.size, verbose=arguments.verbose))
