"""Starts the parking assistant: world, bridge, frame of the lidar, and the two nodes.

Call: ros2 launch bringup.launch.py [world:=depot.sdf] [stop_at:=0.7]
"""

import sys
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
        arguments=[
            "/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock",
            "/lidar/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan",
            "/model/robot/cmd_vel@geometry_msgs/msg/Twist]gz.msgs.Twist",
        ],
        remappings=[("/lidar/scan", "/scan"), ("/model/robot/cmd_vel", "/cmd_vel")],
        output="screen",
    )
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
    return LaunchDescription([world, stop_at, simulator, bridge, ranger, driver])
