"""A shell changes the folder and becomes the program; another decides about -r."""

from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

HERE = Path(__file__).parent


def generate_launch_description():
    world, paused = LaunchConfiguration("world"), LaunchConfiguration("paused")
    decide = 'if [ "$1" = true ]; then exec gz sim -s "$0"; else exec gz sim -s -r "$0"; fi'
    return LaunchDescription(
        [
            DeclareLaunchArgument("world", default_value="lidar_room.sdf"),
            DeclareLaunchArgument("paused", default_value="false"),
            ExecuteProcess(cmd=["bash", "-c", decide, world, paused], name="simulator"),
            Node(
                package="ros_gz_bridge",
                executable="parameter_bridge",
                parameters=[{"config_file": str(HERE / "bridge.yaml")}],
            ),
            ExecuteProcess(
                cmd=["bash", "-c", "cd $0 && exec python3 stopwatch.py --ros-args -p use_sim_time:=true", str(HERE)],
                output="screen",
            ),
        ]
    )
