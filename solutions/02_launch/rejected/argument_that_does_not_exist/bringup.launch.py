"""Starts the simulator with a world, the bridge, and the stopwatch."""

import sys
from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

HERE = Path(__file__).parent


def generate_launch_description():
    world = LaunchConfiguration("world")
    gz_sim = str(Path(get_package_share_directory("ros_gz_sim")) / "launch" / "gz_sim.launch.py")
    return LaunchDescription(
        [
            DeclareLaunchArgument("world", default_value="lidar_room.sdf", description="World to be simulated"),
            DeclareLaunchArgument("paused", default_value="false", description="Whether time stands still at first"),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(gz_sim),
                launch_arguments={"world": world, "paused": LaunchConfiguration("paused")}.items(),
            ),
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
