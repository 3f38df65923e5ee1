"""Starts Gazebo's server with a running world, and the bridge with a configuration file."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration


def generate_launch_description() -> LaunchDescription:
    return LaunchDescription(
        [
            DeclareLaunchArgument("world_sdf_file", default_value="empty.sdf", description="World to simulate"),
            DeclareLaunchArgument("bridge_log_level", default_value="info", description="Log level of the bridge"),
            _include("ros_gz_sim", "gz_sim.launch.py", gz_args=["-r -s ", LaunchConfiguration("world_sdf_file")]),
            _include("ros_gz_bridge", "ros_gz_bridge.launch.py", log_level=LaunchConfiguration("bridge_log_level")),
        ]
    )


def _include(package: str, file: str, **arguments: object) -> IncludeLaunchDescription:
    # A path without substitutions, so that `ros2 launch --show-args` can load the file.
    path = Path(get_package_share_directory(package), "launch", file)
    return IncludeLaunchDescription(PythonLaunchDescriptionSource(str(path)), launch_arguments=arguments.items())
