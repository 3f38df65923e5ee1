from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import LaunchConfiguration


def generate_launch_description():
    paused = LaunchConfiguration("paused")
    return LaunchDescription(
        [
            DeclareLaunchArgument("paused", default_value="false"),
            ExecuteProcess(
                cmd=["gz", "sim", "-s", "lidar_room.sdf"],
                output="screen",
                condition=IfCondition(paused),
            ),
            ExecuteProcess(
                cmd=["gz", "sim", "-s", "-r", "lidar_room.sdf"],
                output="screen",
                condition=UnlessCondition(paused),
            ),
        ]
    )
