from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

CART = str(Path(__file__).parent / "level.sdf")
GZ_SIM = [FindPackageShare("ros_gz_sim"), "launch", "gz_sim.launch.py"]


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("world", default_value="empty.sdf"),
            DeclareLaunchArgument("x", default_value="0.0"),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(PathJoinSubstitution(GZ_SIM)),
                launch_arguments={"gz_args": ["-s -r ", LaunchConfiguration("world")]}.items(),
            ),
            Node(
                package="ros_gz_sim",
                executable="create",
                arguments=["-file", CART, "-name", "scout", "-x", LaunchConfiguration("x")],
                output="screen",
            ),
        ]
    )
