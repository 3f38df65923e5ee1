"""Are the folders of ROS's log and of the course in your home writable? rclpy refuses to start where it cannot log."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping
from pathlib import Path

from gz_course.grader.tools.doctor.probe import Probes
from gz_course.grader.tools.doctor.verdict import Verdict, failed, fine

TITLE = "ROS log folder"


def examine(probes: Probes) -> Verdict:
    """Write a file into the folder of the log."""
    folder = log_folder(os.environ)
    there = folder
    while not there.exists() and there != there.parent:
        there = there.parent
    fix = "set ROS_LOG_DIR to a folder you can write to, for example `export ROS_LOG_DIR=/tmp/ros_log`"
    try:
        with tempfile.TemporaryFile(dir=there) as stream:
            stream.write(b"log")
    except OSError as error:
        return failed(f"{folder} cannot be written: {error.strerror}", fix)
    return fine(f"{folder} can be written")


def log_folder(environment: Mapping[str, str]) -> Path:
    """Return the folder of ROS 2's logs: ROS_LOG_DIR, else ROS_HOME/log, else ~/.ros/log.

    Source: ROS 2 documentation, "Logging and logger configuration".
    """
    if given := environment.get("ROS_LOG_DIR"):
        return Path(given).expanduser()
    if home := environment.get("ROS_HOME"):
        return Path(home).expanduser() / "log"
    return Path(environment.get("HOME") or "~").expanduser() / ".ros" / "log"
