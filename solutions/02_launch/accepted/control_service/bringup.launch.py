"""Every world starts paused; the control service lets it run unless it is to stay so."""

import sys
from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.conditions import UnlessCondition
from launch.substitutions import LaunchConfiguration, PythonExpression
from launch_ros.actions import Node

HERE = Path(__file__).parent
TYPES = ["--reqtype", "gz.msgs.WorldControl", "--reptype", "gz.msgs.Boolean", "--timeout", "60000"]


def generate_launch_description():
    world = LaunchConfiguration("world")
    # The worlds of this course are called like their files.
    service = ["/world/", PythonExpression(["'", world, "'.removesuffix('.sdf')"]), "/control"]
    return LaunchDescription(
        [
            DeclareLaunchArgument("world", default_value="lidar_room.sdf"),
            DeclareLaunchArgument("paused", default_value="false"),
            ExecuteProcess(cmd=["gz", "sim", "-s", world]),
            ExecuteProcess(
                cmd=["gz", "service", "-s", service, *TYPES, "--req", "pause: false"],
                condition=UnlessCondition(LaunchConfiguration("paused")),
            ),
            Node(
                package="ros_gz_bridge",
                executable="parameter_bridge",
                parameters=[{"config_file": str(HERE / "bridge.yaml")}],
            ),
            ExecuteProcess(
                cmd=[sys.executable, str(HERE / "stopwatch.py"), "--ros-args", "-p", "use_sim_time:=true"],
            ),
        ]
    )
