"""Starts Gazebo with the arguments `gz_args`, as `gz sim <gz_args>`: `gz_args:="-r -s empty.sdf"`."""

import os
import shlex
import sys
from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, LogInfo, Shutdown
from launch.conditions import IfCondition, LaunchConfigurationNotEquals
from launch.substitutions import IfElseSubstitution, LaunchConfiguration


def generate_launch_description() -> LaunchDescription:
    # The `gz` beside the Python that runs this launch file takes precedence over PATH.
    beside = Path(sys.executable).with_name("gz")
    gz = shlex.quote(str(beside)) if os.access(beside, os.X_OK) else "gz"
    words = [LaunchConfiguration("gz_args"), " ", LaunchConfiguration("ign_args"), " --force-version "]
    words += [LaunchConfiguration("gz_version")]
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "gz_args", default_value="", description="Arguments to be passed to Gazebo Sim: -r to run, the world"
            ),
            DeclareLaunchArgument("gz_version", default_value="8", description="Gazebo Sim's major version"),
            DeclareLaunchArgument("ign_args", default_value="", description="Deprecated: use gz_args"),
            DeclareLaunchArgument("ign_version", default_value="", description="Deprecated: use gz_version"),
            DeclareLaunchArgument("debugger", default_value="false", description="Run in a debugger (gdb)"),
            DeclareLaunchArgument(
                "on_exit_shutdown", default_value="false", description="Shutdown on gz-sim exit: true or false"
            ),
            _deprecated("ign_args", "gz_args"),
            _deprecated("ign_version", "gz_version"),
            ExecuteProcess(
                # The shell splits gz_args and executes Gazebo in its place, so that the exit code is that of Gazebo.
                cmd=["/bin/sh", "-c", ["exec ", gz, " sim ", *words]],
                name="gazebo",
                output="screen",
                prefix=IfElseSubstitution(
                    LaunchConfiguration("debugger"),
                    "x-terminal-emulator -e gdb -ex run --args",
                    LaunchConfiguration("launch-prefix", default=""),
                ),
                on_exit=[
                    Shutdown(reason="Gazebo has ended", condition=IfCondition(LaunchConfiguration("on_exit_shutdown")))
                ],
            ),
        ]
    )


def _deprecated(old: str, new: str) -> LogInfo:
    return LogInfo(msg=f"'{old}' is deprecated: use '{new}'", condition=LaunchConfigurationNotEquals(old, ""))
