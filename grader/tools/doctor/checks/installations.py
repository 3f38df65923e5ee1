"""Is another ROS 2 or Gazebo set up in this shell, and whose commands come first?"""

from __future__ import annotations

import importlib.util
import os
import shutil
import sys
from collections.abc import Mapping
from pathlib import Path

from gz_course.grader.tools.doctor.probe import Probes
from gz_course.grader.tools.doctor.verdict import Verdict, fine, warning
from gz_course.sim.ros.ros2.hand_over import sourced_ros2

TITLE = "other installations of ROS 2 and Gazebo"
COMMANDS = ("course", "ros2", "gz", "parameter_bridge")


def examine(probes: Probes) -> Verdict:
    """Examine PATH, AMENT_PREFIX_PATH and Python's own path."""
    spec = importlib.util.find_spec("rclpy")
    return judge(os.environ, Path(sys.prefix), spec.origin if spec else None)


def judge(environment: Mapping[str, str], prefix: Path, rclpy: str | None) -> Verdict:
    """Return the verdict on a shell's variables for the environment at `prefix`.

    `rclpy` is the file from which Python imports it.
    """
    fix = "open a terminal in which no other ROS 2 or Gazebo is sourced, and `source .venv/bin/activate` there"
    if rclpy is not None and not Path(rclpy).resolve().is_relative_to(prefix.resolve()):
        return warning(f"rclpy is imported from {rclpy}, not from this environment", fix)
    if (real := sourced_ros2(environment)) is not None:
        return warning(f"another ROS 2 is sourced: `ros2` is {real}", f"keep it if you want it; else {fix}")
    path = environment.get("PATH", os.defpath)
    found = {name: shutil.which(name, path=path) for name in COMMANDS}
    elsewhere = [
        f"`{n}` is {p}" for n, p in found.items() if p and Path(p).parent.resolve() != (prefix / "bin").resolve()
    ]
    if elsewhere:
        return warning(
            f"other programs come first: {', '.join(elsewhere)}",
            f"`source {prefix}/bin/activate` puts those of this environment first",
        )
    if missing := [name for name, place in found.items() if place is None]:
        return warning(
            f"no such command on PATH: {', '.join(missing)}",
            "install again with `pip install -c constraints.txt -e .` in the course's folder",
        )
    others = [name for name in ("ROS_DISTRO", "GZ_VERSION") if environment.get(name)]
    if others:
        return warning(
            f"{others[0]} is set by another installation, but the commands of this environment come first", fix
        )
    return fine(f"no other one is set up; ros2 and gz are those in {prefix / 'bin'}")
