"""Check ROS setup and other potential issues (what `course doctor` finds); `hello` tries the network."""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
from pathlib import Path

from gz_course.sim.ros.ros2.child import ChildError, run_child
from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.option_values import seconds, time_to_live

_DEADLINE = 30.0  # [s] for `course doctor --help`


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--json", action="store_true", help="For programs")
    for names in (("-r", "--report"), ("-rf", "--report-failed"), ("-iw", "--include-warnings")):
        parser.add_argument(*names, action="store_true", help="Accepted and ignored: everything is printed anyway")
    parser.add_argument("-ep", "--exclude-packages", action="store_true", help="Accepted and ignored")
    verbs = parser.add_subparsers(dest="verb", metavar="hello", help="Check network connectivity between hosts")
    hello = verbs.add_parser("hello", description="Check network connectivity between multiple hosts.")
    hello.add_argument("-t", "--topic", default="/canyouhearme", help="Name of the topic (default: /canyouhearme)")
    hello.add_argument(
        "-ep", "--emit-period", type=seconds, default=0.1, metavar="N", help="Seconds between greetings (default: 0.1)"
    )
    hello.add_argument(
        "-pp", "--print-period", type=seconds, default=1.0, metavar="N", help="Seconds between tables (default: 1)"
    )
    hello.add_argument("--ttl", type=time_to_live, metavar="N", help="Number of networks that multicast may cross")
    hello.add_argument("-1", "--once", action="store_true", help="Print one table and exit")


def main(arguments: argparse.Namespace) -> int:
    if arguments.verb == "hello":
        from gz_course.sim.ros.ros2.hello import hello

        hello(arguments)
        return 0
    course = _course()
    try:
        known = subprocess.run(
            [course, "doctor", "--help"], capture_output=True, timeout=_DEADLINE, stdin=subprocess.DEVNULL
        )
        if known.returncode == 2:
            raise CommandError(f"`ros2 doctor` is `course doctor` here, and {course} has no such command yet")
        return run_child([course, "doctor", *(["--json"] if arguments.json else [])]) % 256
    except subprocess.TimeoutExpired:
        raise CommandError(f"{course} does not answer within {_DEADLINE:g} s") from None
    except (ChildError, OSError) as error:
        raise CommandError(f"{course} does not start: {error}") from None


def _course() -> str:
    beside = Path(sys.executable).with_name("course")
    found = str(beside) if beside.is_file() else shutil.which("course")
    if found is None:
        raise CommandError(
            "`ros2 doctor` is `course doctor` here, and there is no `course` command in this environment"
        )
    return found
