"""The system of this exercise: the warehouse, the bridge, and the node that patrols. End it with Ctrl-C."""

import sys
from pathlib import Path

from launch import LaunchDescription
from launch.actions import ExecuteProcess, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

HERE = Path(__file__).parent


def generate_launch_description():
    gz_sim = PathJoinSubstitution([FindPackageShare("ros_gz_sim"), "launch", "gz_sim.launch.py"])
    return LaunchDescription(
        [
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(gz_sim),
                launch_arguments={"gz_args": "-r -s warehouse.sdf"}.items(),
            ),
            Node(
                package="ros_gz_bridge",
                executable="parameter_bridge",
                parameters=[{"config_file": str(HERE / "bridge.yaml")}],
            ),
            ExecuteProcess(
                cmd=[sys.executable, str(HERE / "given_node.py"), "--ros-args", "-p", "use_sim_time:=true"],
            ),
        ]
    )
