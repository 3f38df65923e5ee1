"""Followers are started as modules, with `python -m` in the folder of this file; the bridge with `ros2 run`."""

import sys
from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, IncludeLaunchDescription, OpaqueFunction
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

HERE = Path(__file__).parent
GAP = 1.2  # [m] from robot to robot


def create(number):
    return Node(
        package="ros_gz_sim",
        executable="create",
        arguments=[
            *("-file", str(HERE / "robot.sdf"), "-name", f"robot{number}"),
            *("-x", str(-GAP * (number - 1)), "-z", "0.01"),
        ],
    )


def follower(number):
    names = ["-r", f"__ns:=/robot{number}", "-r", f"front/odom:=/robot{number - 1}/odom"]
    parameters = ["-p", "use_sim_time:=true", "-p", f"gap:={GAP}"]
    command = [sys.executable, "-m", "follower_node", "--ros-args", *names, *parameters]
    return ExecuteProcess(cmd=command, cwd=str(HERE), output="screen")


def bridge(count):
    """One bridge for all: the clock once, and the two topics of each robot."""
    arguments, remappings = ["/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock"], []
    for number in range(1, count + 1):
        gazebo, ros = f"/model/robot{number}", f"/robot{number}"
        arguments.append(f"{gazebo}/cmd_vel@geometry_msgs/msg/Twist]gz.msgs.Twist")
        arguments.append(f"{gazebo}/odometry@nav_msgs/msg/Odometry[gz.msgs.Odometry")
        remappings += ["-r", f"{gazebo}/cmd_vel:={ros}/cmd_vel", "-r", f"{gazebo}/odometry:={ros}/odom"]
    return ExecuteProcess(
        cmd=["ros2", "run", "ros_gz_bridge", "parameter_bridge", *arguments, "--ros-args", *remappings]
    )


def convoy(context):
    count = int(LaunchConfiguration("robots").perform(context))
    robots = [create(number) for number in range(1, count + 1)]
    followers = [follower(number) for number in range(2, count + 1)]
    return [bridge(count), *robots, *followers]


def generate_launch_description():
    gz_sim = PathJoinSubstitution([FindPackageShare("ros_gz_sim"), "launch", "gz_sim.launch.py"])
    return LaunchDescription(
        [
            DeclareLaunchArgument("robots", default_value="2", description="Number of robots in the convoy"),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(gz_sim),
                launch_arguments={"gz_args": f"-s -r {HERE / 'field.sdf'}"}.items(),
            ),
            OpaqueFunction(function=convoy),
        ]
    )
