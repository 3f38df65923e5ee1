"""The simulator is started by Python, with subprocess.Popen: the launch knows nothing of it."""

import subprocess
import sys
from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, OpaqueFunction
from launch_ros.actions import Node

HERE = Path(__file__).parent


def start_simulator(context):
    arguments = context.launch_configurations
    run = [] if arguments["paused"] == "true" else ["-r"]
    subprocess.Popen(["gz", "sim", "-s", *run, arguments["world"]])


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("world", default_value="lidar_room.sdf"),
            DeclareLaunchArgument("paused", default_value="false"),
            OpaqueFunction(function=start_simulator),
            Node(
                package="ros_gz_bridge",
                executable="parameter_bridge",
                parameters=[{"config_file": str(HERE / "bridge.yaml")}],
            ),
            ExecuteProcess(
                cmd=[sys.executable, str(HERE / "stopwatch.py"), "--ros-args", "-p", "use_sim_time:=true"],
            ),
        ]
    )
