"""Starts the simulator with a world, the bridge, and the stopwatch."""

import sys
from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

HERE = Path(__file__).parent


def simulator(context):
    world = LaunchConfiguration("world").perform(context)
    paused = LaunchConfiguration("paused").perform(context)
    run = [] if paused else ["-r"]
    return [ExecuteProcess(cmd=["gz", "sim", "-s", *run, world], output="screen")]


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("world", default_value="lidar_room.sdf", description="World to be simulated"),
            DeclareLaunchArgument("paused", default_value="false", description="Whether time stands still at first"),
            OpaqueFunction(function=simulator),
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
