"""An OpaqueFunction looks at the arguments and decides in Python; the node is started when the simulator has been."""

import pathlib
import sys

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, OpaqueFunction, RegisterEventHandler
from launch.event_handlers import OnProcessStart
from launch_ros.actions import Node

here = pathlib.Path(__file__).resolve().parent


def start(context):
    arguments = context.launch_configurations
    words = ["gz", "sim", "-s", "-v1"]
    if arguments["paused"].lower() not in ("true", "1"):
        words.append("-r")
    simulator = ExecuteProcess(cmd=[*words, arguments["world"]], name="simulator")
    bridge = Node(
        package="ros_gz_bridge",
        executable="parameter_bridge",
        name="clock_bridge",
        parameters=[{"config_file": str(here / "bridge.yaml"), "use_sim_time": False}],
    )
    stopwatch = ExecuteProcess(
        cmd=[sys.executable, "stopwatch.py", "--ros-args", "-p", "use_sim_time:=true"], cwd=str(here), output="both"
    )
    return [simulator, RegisterEventHandler(OnProcessStart(target_action=simulator, on_start=[bridge, stopwatch]))]


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("world", default_value="lidar_room.sdf"),
            DeclareLaunchArgument("paused", default_value="false"),
            OpaqueFunction(function=start),
        ]
    )
