from launch import LaunchDescription
from launch.actions import ExecuteProcess


def generate_launch_description():
    return LaunchDescription(
        [
            ExecuteProcess(cmd=["gz", "sim", "-s", "-r", "lidar_room.sdf"], output="screen"),
        ]
    )
