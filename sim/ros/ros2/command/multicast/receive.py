"""Receive a single UDP multicast packet."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2 import multicast


def add_arguments(parser: argparse.ArgumentParser) -> None:
    pass


def main(arguments: argparse.Namespace) -> None:
    """Wait for one datagram, or for Ctrl-C, which is no failure in ROS 2."""
    try:
        with multicast.receiver() as heard:
            print("Waiting for UDP multicast datagram...")
            text, host, port = multicast.received(heard)
            print(f"Received from {host}:{port}: '{text}'")
    except KeyboardInterrupt:
        return
