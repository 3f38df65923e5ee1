"""Starts a world, puts the robot into it, and connects it with ROS."""

from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

HERE = Path(__file__).parent


def generate_launch_description():
    # This is how many begin. Three things in it cannot work, and several are missing.
    return LaunchDescription(
        [
            DeclareLaunchArgument("world", default_value=str(HERE / "yard.sdf")),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource("gz_sim.launch.py"),
                launch_arguments={"world": LaunchConfiguration("world")}.items(),
            ),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[{"robot_description": robot_description}],
            ),
            Node(
                package="ros_gz_sim",
                executable="create",
                arguments=["-topic", "/robot_description", "-name", "scout"],
            ),
            Node(
                package="ros_gz_bridge",
                executable="parameter_bridge",
                arguments=["/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock"],
            ),
        ]
    )
