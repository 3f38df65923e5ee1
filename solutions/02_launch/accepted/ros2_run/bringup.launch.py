"""The commands of the shell, word for word: the bridge is started with `ros2 run`."""

import sys
from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import LaunchConfiguration

HERE = Path(__file__).parent


def generate_launch_description():
    world, paused = LaunchConfiguration("world"), LaunchConfiguration("paused")
    config_file = f"config_file:={HERE / 'bridge.yaml'}"
    return LaunchDescription(
        [
            DeclareLaunchArgument("world", default_value="lidar_room.sdf"),
            DeclareLaunchArgument("paused", default_value="false"),
            ExecuteProcess(cmd=["gz", "sim", "-s", world], condition=IfCondition(paused)),
            ExecuteProcess(cmd=["gz", "sim", "-s", "-r", world], condition=UnlessCondition(paused)),
            ExecuteProcess(cmd=["ros2", "run", "ros_gz_bridge", "parameter_bridge", "--ros-args", "-p", config_file]),
            ExecuteProcess(
                cmd=[sys.executable, str(HERE / "stopwatch.py"), "--ros-args", "-p", "use_sim_time:=true"],
                output="screen",
            ),
        ]
    )
