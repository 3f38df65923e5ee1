"""One command that starts the simulator, the bridge and the stopwatch."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, LogInfo
from launch.substitutions import LaunchConfiguration


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("world", default_value="lidar_room.sdf", description="World to be simulated"),
            LogInfo(msg=["the world would be ", LaunchConfiguration("world")]),
            # Your part: a second argument, paused; the simulator; the bridge with bridge.yaml; the node stopwatch.py.
        ]
    )
