"""Bridge and frame of the lidar are started with the commands of a shell, `ros2 run`."""

import sys
from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node

HERE = Path(__file__).parent


def ros2_run(package, executable, *arguments):
    return ExecuteProcess(cmd=["ros2", "run", package, executable, *arguments], output="screen")


def generate_launch_description():
    world = DeclareLaunchArgument("world", default_value="bay.sdf", description="World file in worlds")
    stop_at = DeclareLaunchArgument("stop_at", default_value="1.0", description="Distance to the wall [m]")

    simulator = ExecuteProcess(
        cmd=["gz", "sim", "-s", "-r", PathJoinSubstitution([str(HERE / "worlds"), LaunchConfiguration("world")])],
        output="screen",
    )
    config_file = f"config_file:={HERE / 'bridge.yaml'}"
    bridge = ros2_run("ros_gz_bridge", "parameter_bridge", "--ros-args", "-p", config_file)
    # The lidar stands on a mast, 0.2 m behind base_link and 0.19 m above it.
    place = ["--x", "-0.2", "--z", "0.19", "--frame-id", "base_link", "--child-frame-id", "lidar_link"]
    lidar_frame = ros2_run("tf2_ros", "static_transform_publisher", *place)
    ranger = Node(
        executable=sys.executable,
        arguments=[str(HERE / "ranger_node.py")],
        parameters=[{"use_sim_time": True}],
        output="screen",
    )
    driver = Node(
        executable=sys.executable,
        arguments=[str(HERE / "driver_node.py")],
        parameters=[{"use_sim_time": True, "stop_at": LaunchConfiguration("stop_at")}],
        output="screen",
    )
    return LaunchDescription([world, stop_at, simulator, bridge, lidar_frame, ranger, driver])
