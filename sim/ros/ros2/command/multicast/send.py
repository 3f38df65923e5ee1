"""Send a single UDP multicast packet."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2 import multicast
from gz_course.sim.ros.ros2.option_values import time_to_live


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--ttl", type=time_to_live, metavar="N", help="Number of networks that the packet may cross")


def main(arguments: argparse.Namespace) -> None:
    print("Sending one UDP multicast datagram...")
    multicast.send(b"Hello World!", arguments.ttl)
