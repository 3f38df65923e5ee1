"""Run a launch test, in a ROS domain of its own."""

from __future__ import annotations

import argparse
import contextlib
import os
import random
import socket
from collections.abc import Iterator

from gz_course.sim.ros.launch_testing import launch_test
from gz_course.sim.ros.launch_testing_ros.test_runner import LaunchTestRunner
from gz_course.sim.ros.ros2.errors import CommandError

_DOMAINS = range(1, 101)
# A domain is taken while a socket is bound to this port plus its number.
# Source: ros2/ament_cmake_ros, domain_coordinator
_FIRST_PORT = 22119


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--disable-isolation", action="store_true", help="Use ROS_DOMAIN_ID as it is, not a domain that nobody uses"
    )
    launch_test.add_arguments(parser)
    parser.set_defaults(_parser=parser)


def main(arguments: argparse.Namespace) -> int:
    """Return 0 if all tests pass, 1 if one fails."""
    with contextlib.nullcontext() if arguments.disable_isolation else _free_domain():
        return launch_test.run(arguments._parser, arguments, LaunchTestRunner)


@contextlib.contextmanager
def _free_domain() -> Iterator[None]:
    """Set ROS_DOMAIN_ID to a domain that no other test of this machine uses."""
    for number in random.sample(_DOMAINS, len(_DOMAINS)):
        with socket.socket() as taken:
            try:
                taken.bind(("127.0.0.1", _FIRST_PORT + number))
            except OSError:
                continue
            os.environ["ROS_DOMAIN_ID"] = str(number)
            print(f"Running with ROS_DOMAIN_ID {number}", flush=True)
            yield
            return
    raise CommandError("all ROS domains from 1 to 100 are in use by tests; end some, or use --disable-isolation")
