"""The program `gzserver`: Gazebo's server with the world named by ROS parameters, running.

`gz_server.launch.py` starts it. It reads the parameters and becomes `gz sim -r -s` by `exec`, so signals and the exit
code are those of the simulator.

Source: ros_gz_sim/src/gzserver.cpp, https://github.com/gazebosim/ros_gz
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from gz_course.sim.bridge.ros_gz_sim.flags import Flag, read, usage, with_parameters
from gz_course.sim.ros.ros_program.errors import UsageError
from gz_course.sim.ros.ros_program.program import run

if TYPE_CHECKING:
    from rclpy.node import Node

FLAGS = (
    Flag("world_sdf_file", "World: a path, a name in GZ_SIM_RESOURCE_PATH, or a built-in world"),
    Flag("world_sdf_string", "SDF text of the world"),
    Flag("initial_sim_time", "Time the world starts at, in s", "number"),
    Flag("verbosity_level", "How much is said: 0 to 4", "whole"),
)
HELP = usage("usage: gzserver --ros-args -p world_sdf_file:=FILE | -p world_sdf_string:=SDF\n", FLAGS)


def main(argv: list[str] | None = None) -> int:
    """Read the parameters and replace this process by the simulator; return 2 if they cannot be used."""
    command: list[str] = []

    def decide(node: Node, arguments: list[str]) -> int:
        command.extend(_command(with_parameters(node, read(arguments, FLAGS), FLAGS)))
        return 0

    code = run("gzserver", "gzserver", decide, HELP, argv)
    if command:
        os.execv(command[0], command)
    return code


def _command(values: dict[str, object]) -> list[str]:
    file, text = values.get("world_sdf_file"), values.get("world_sdf_string")
    if bool(file) == bool(text):
        raise UsageError("say which world: give world_sdf_file or world_sdf_string, one of them")
    gz = [sys.executable, "-P", "-m", "gz_course.sim.gz.command"]
    command = [*gz, "sim", "-r", "-s", str(file or _in_memory(str(text)))]
    if "initial_sim_time" in values:
        command += ["--initial-sim-time", str(values["initial_sim_time"])]
    if "verbosity_level" in values:
        command += [f"-v{values['verbosity_level']}"]
    return command


def _in_memory(text: str) -> Path:
    """Return the path of a file in memory that lasts as long as this process, also after `exec`."""
    descriptor = os.memfd_create("world_sdf_string", 0)  # without MFD_CLOEXEC: it outlives exec
    with os.fdopen(os.dup(descriptor), "w", encoding="utf-8") as file:
        file.write(text)
    return Path(f"/proc/{os.getpid()}/fd/{descriptor}")


if __name__ == "__main__":
    sys.exit(main())
