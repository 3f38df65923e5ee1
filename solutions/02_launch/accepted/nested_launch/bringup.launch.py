"""The bridge has a launch of its own, started as in a shell: `ros2 launch ros_gz_bridge ros_gz_bridge.launch.py`."""

import sys
from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import LaunchConfiguration

HERE = Path(__file__).parent
BRIDGE = ["ros2", "launch", "ros_gz_bridge", "ros_gz_bridge.launch.py", "bridge_name:=bridge"]


def generate_launch_description():
    world, paused = LaunchConfiguration("world"), LaunchConfiguration("paused")
    config_file = f"config_file:={HERE / 'bridge.yaml'}"
    return LaunchDescription(
        [
            DeclareLaunchArgument("world", default_value="lidar_room.sdf"),
            DeclareLaunchArgument("paused", default_value="false"),
            ExecuteProcess(cmd=["gz", "sim", "-s", world], condition=IfCondition(paused)),
            ExecuteProcess(cmd=["gz", "sim", "-s", "-r", world], condition=UnlessCondition(paused)),
            ExecuteProcess(cmd=[*BRIDGE, config_file]),
            ExecuteProcess(
                cmd=[sys.executable, str(HERE / "stopwatch.py"), "--ros-args", "-p", "use_sim_time:=true"],
                output="screen",
            ),
        ]
    )
