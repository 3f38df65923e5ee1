import sys

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, OpaqueFunction
from launch.substitutions import LaunchConfiguration


def spinner(number):
    names = ["-r", f"__ns:=/robot{number}"]
    command = [sys.executable, "spinner.py", "--ros-args", *names]
    return ExecuteProcess(cmd=command, output="screen")


def spinners(context):
    count = int(LaunchConfiguration("robots").perform(context))
    return [spinner(number) for number in range(2, count + 1)]


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("robots", default_value="2"),
            OpaqueFunction(function=spinners),
        ]
    )
