"""Check ROS setup and other potential issues (what `course doctor` finds)."""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
from pathlib import Path

from gz_course.sim.ros2.child import ChildError, run_child
from gz_course.sim.ros2.errors import CommandError

_DEADLINE = 30.0  # [s] for `course doctor --help`


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--json", action="store_true", help="For programs")
    for names in (("-r", "--report"), ("-rf", "--report-failed"), ("-iw", "--include-warnings")):
        parser.add_argument(*names, action="store_true", help="Accepted and ignored: everything is printed anyway")


def main(arguments: argparse.Namespace) -> int:
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
