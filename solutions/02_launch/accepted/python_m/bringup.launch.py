"""A shell starts the bridge with `ros2 run` and waits for it; the stopwatch is a module, run with `python -m`."""

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
            ExecuteProcess(
                cmd=["bash", "-c", "ros2 run ros_gz_bridge parameter_bridge --ros-args -p $0; exit $?", config_file]
            ),
            ExecuteProcess(
                cmd=[sys.executable, "-m", "stopwatch", "--ros-args", "-p", "use_sim_time:=true"],
                cwd=str(HERE),
                output="screen",
            ),
        ]
    )
