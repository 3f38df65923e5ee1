"""Starts a field and a convoy of robots: ros2 launch convoy.launch.py robots:=3"""

from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare

HERE = Path(__file__).parent
GAP = 1.2  # [m] from robot to robot


def generate_launch_description():
    gz_sim = PathJoinSubstitution([FindPackageShare("ros_gz_sim"), "launch", "gz_sim.launch.py"])
    return LaunchDescription(
        [
            DeclareLaunchArgument("robots", default_value="2", description="Number of robots in the convoy"),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(gz_sim),
                launch_arguments={"gz_args": f"-s {HERE / 'field.sdf'}"}.items(),
            ),
            # Your part: the robots, their bridges and their followers. How many there are is known only when the launch
            # runs: OpaqueFunction(function=...) calls a function that gets the context and returns a list of actions.
        ]
    )
