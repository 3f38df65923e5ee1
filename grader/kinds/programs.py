"""Commands that start the program of a submission in its sandbox."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from gz_course.grader.exercise.trial import Trial


def node_command(program: Path, trial: Trial | None = None) -> list[str]:
    """Return the command that runs a Python file with an rclpy node, with simulated time switched on."""
    return [sys.executable, "-P", "-m", "course_agent.run_node", str(program), "--ros-args", "-p", "use_sim_time:=true"]


def launch_command(program: Path, arguments: Mapping[str, Any]) -> list[str]:
    """Return the command that runs a launch file, as `ros2 launch FILE NAME:=VALUE ...` does."""
    words = [f"{name}:={str(value).lower() if isinstance(value, bool) else value}" for name, value in arguments.items()]
    ros2 = "import sys; from gz_course.sim.ros2.command_line import main; sys.exit(main())"
    return [sys.executable, "-P", "-c", ros2, "launch", str(program), *words]
