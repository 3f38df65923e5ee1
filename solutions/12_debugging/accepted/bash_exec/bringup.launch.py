"""A shell goes to the folder of this file and becomes the node."""

from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node

HERE = Path(__file__).parent


def generate_launch_description():
    world = DeclareLaunchArgument("world", default_value="bay.sdf", description="World file in worlds")
    stop_at = DeclareLaunchArgument("stop_at", default_value="1.0", description="Distance to the wall [m]")

    simulator = ExecuteProcess(
        cmd=["gz", "sim", "-s", "-r", PathJoinSubstitution([str(HERE / "worlds"), LaunchConfiguration("world")])],
        output="screen",
    )
    bridge = Node(
        package="ros_gz_bridge",
        executable="parameter_bridge",
        parameters=[{"config_file": str(HERE / "bridge.yaml")}],
        output="screen",
    )
    # The lidar stands on a mast, 0.2 m behind base_link and 0.19 m above it.
    lidar_frame = Node(
        package="tf2_ros",
        executable="static_transform_publisher",
        name="lidar_frame",
        arguments=["--x", "-0.2", "--z", "0.19", "--frame-id", "base_link", "--child-frame-id", "lidar_link"],
        output="screen",
    )
    start = f"cd '{HERE}' && exec python3 $0 --ros-args -p use_sim_time:=true"
    ranger = ExecuteProcess(cmd=["bash", "-c", start, "ranger_node.py"], output="screen")
    stop = [start, " -p stop_at:=", LaunchConfiguration("stop_at")]
    driver = ExecuteProcess(cmd=["bash", "-c", stop, "driver_node.py"], output="screen")
    return LaunchDescription([world, stop_at, simulator, bridge, lidar_frame, ranger, driver])
