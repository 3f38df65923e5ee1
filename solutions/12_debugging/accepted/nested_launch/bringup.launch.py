"""Simulator and bridge have launches of their own, started as in a shell; the nodes are modules, run with `python -m`."""

import sys
from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node

HERE = Path(__file__).parent


def ros2_launch(package, file, *arguments):
    return ExecuteProcess(cmd=["ros2", "launch", package, file, *arguments], output="screen")


def module(name, *parameters):
    words = ["--ros-args", "-p", "use_sim_time:=true", *parameters]
    return ExecuteProcess(cmd=[sys.executable, "-m", name, *words], cwd=str(HERE), output="screen")


def generate_launch_description():
    world = DeclareLaunchArgument("world", default_value="bay.sdf", description="World file in worlds")
    stop_at = DeclareLaunchArgument("stop_at", default_value="1.0", description="Distance to the wall [m]")

    path = PathJoinSubstitution([str(HERE / "worlds"), LaunchConfiguration("world")])
    simulator = ros2_launch("ros_gz_sim", "gz_sim.launch.py", ["gz_args:=-s -r ", path])
    config_file = f"config_file:={HERE / 'bridge.yaml'}"
    bridge = ros2_launch("ros_gz_bridge", "ros_gz_bridge.launch.py", "bridge_name:=bridge", config_file)
    # The lidar stands on a mast, 0.2 m behind base_link and 0.19 m above it.
    lidar_frame = Node(
        package="tf2_ros",
        executable="static_transform_publisher",
        name="lidar_frame",
        arguments=["--x", "-0.2", "--z", "0.19", "--frame-id", "base_link", "--child-frame-id", "lidar_link"],
        output="screen",
    )
    ranger = module("ranger_node")
    driver = module("driver_node", "-p", ["stop_at:=", LaunchConfiguration("stop_at")])
    return LaunchDescription([world, stop_at, simulator, bridge, lidar_frame, ranger, driver])
