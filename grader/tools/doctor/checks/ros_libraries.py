"""Does this Python find the libraries of the ROS wheels?

The wheels restart every Python once, with their folders in LD_LIBRARY_PATH and a guard variable. A shell that hands on
only one of the two, or both to another environment, breaks `import rclpy`.
"""

from __future__ import annotations

import os
import sys
import sysconfig
from collections.abc import Mapping
from pathlib import Path

from gz_course.grader.run.sandbox import WHEEL_VARIABLES
from gz_course.grader.tools.doctor.probe import Probes
from gz_course.grader.tools.doctor.verdict import Verdict, failed, fine

TITLE = "libraries of the ROS wheels"
GUARD, LIBRARY_PATH = WHEEL_VARIABLES


def examine(probes: Probes) -> Verdict:
    """Compare the two variables of this process with the existing folders."""
    return judge(os.environ, library_folders(Path(sysconfig.get_path("purelib"))))


def library_folders(packages: Path) -> list[Path]:
    """Return the folders of libraries that the ROS wheels install."""
    return sorted(path.resolve() for path in packages.glob("ros_*.libs") if path.is_dir())


def judge(environment: Mapping[str, str], folders: list[Path]) -> Verdict:
    """Return the verdict on an environment's variables for these folders."""
    unset = f"run `unset {GUARD} {LIBRARY_PATH}` and try again"
    there = {Path(part).resolve() for part in environment.get(LIBRARY_PATH, "").split(os.pathsep) if part}
    missing = [folder for folder in folders if folder not in there]
    if not environment.get(GUARD):
        return failed(
            f"{GUARD} is not set: the wheels' start-up file did not run",
            f"install again: `{sys.prefix}/bin/pip install --force-reinstall ros-wheels-bootstrapper`",
        )
    if missing:
        return failed(
            f"{GUARD} is set but {LIBRARY_PATH} lacks {missing[0]}: only one of them was handed on, or both by another "
            "environment",
            unset,
        )
    return fine(f"{GUARD} and {LIBRARY_PATH} fit together ({len(folders)} folders of libraries)")
