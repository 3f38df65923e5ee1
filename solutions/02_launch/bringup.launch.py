"""Starts the simulator with a world, the bridge, and the stopwatch."""

import sys
from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

HERE = Path(__file__).parent


def generate_launch_description():
    world, paused = LaunchConfiguration("world"), LaunchConfiguration("paused")
    return LaunchDescription(
        [
            DeclareLaunchArgument("world", default_value="lidar_room.sdf", description="World to be simulated"),
            DeclareLaunchArgument("paused", default_value="false", description="Whether time stands still at first"),
            ExecuteProcess(cmd=["gz", "sim", "-s", world], condition=IfCondition(paused), output="screen"),
            ExecuteProcess(cmd=["gz", "sim", "-s", "-r", world], condition=UnlessCondition(paused), output="screen"),
            Node(
                package="ros_gz_bridge",
                executable="parameter_bridge",
                parameters=[{"config_file": str(HERE / "bridge.yaml")}],
                output="screen",
            ),
            ExecuteProcess(
                cmd=[sys.executable, str(HERE / "stopwatch.py"), "--ros-args", "-p", "use_sim_time:=true"],
                output="screen",
            ),
        ]
    )
