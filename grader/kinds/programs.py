"""Commands that start the program of a submission in its sandbox."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from gz_course.grader.exercise.trial import Trial


def node_command(program: Path, trial: Trial | None = None) -> list[str]:
    """Return the command that runs a Python file with an rclpy node: in simulated time, with the trial's parameters.

    Values are written as JSON, which is YAML, too: a text in quotes stays a text.
    """
    parameters = {"use_sim_time": True} | (trial.parameters if trial else {})
    words = [word for name, value in parameters.items() for word in ("-p", f"{name}:={json.dumps(value)}")]
    return [sys.executable, "-P", "-m", "course_agent.run_node", str(program), "--ros-args", *words]


def launch_command(program: Path, arguments: Mapping[str, Any]) -> list[str]:
    """Return the command that runs a launch file, as `ros2 launch FILE NAME:=VALUE ...` does."""
    words = [f"{name}:={str(value).lower() if isinstance(value, bool) else value}" for name, value in arguments.items()]
    ros2 = "import sys; from gz_course.sim.ros.ros2.command_line import main; sys.exit(main())"
    return [sys.executable, "-P", "-c", ros2, "launch", str(program), *words]
