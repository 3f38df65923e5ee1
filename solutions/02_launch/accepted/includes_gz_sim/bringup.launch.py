"""gz_sim.launch.py of ros_gz_sim is included; gz_args is put together by a PythonExpression."""

import os
import sys

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution, PythonExpression, ThisLaunchFileDir
from launch_ros.actions import Node


def generate_launch_description():
    gz_sim = os.path.join(get_package_share_directory("ros_gz_sim"), "launch", "gz_sim.launch.py")
    run = PythonExpression(["'' if '", LaunchConfiguration("paused"), "' == 'true' else '-r '"])
    return LaunchDescription(
        [
            DeclareLaunchArgument("world", default_value="lidar_room.sdf"),
            DeclareLaunchArgument("paused", default_value="false", choices=["true", "false"]),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(gz_sim),
                launch_arguments={"gz_args": ["-s ", run, LaunchConfiguration("world")]}.items(),
            ),
            Node(
                package="ros_gz_bridge",
                executable="parameter_bridge",
                arguments=["/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock"],
            ),
            ExecuteProcess(
                cmd=[
                    sys.executable,
                    PathJoinSubstitution([ThisLaunchFileDir(), "stopwatch.py"]),
                    "--ros-args",
                    "-p",
                    "use_sim_time:=true",
                ]
            ),
        ]
    )
