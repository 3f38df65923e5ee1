"""Starts a field and a convoy of robots: ros2 launch convoy.launch.py robots:=3"""

import sys
from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, IncludeLaunchDescription, OpaqueFunction, TimerAction
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node, PushRosNamespace
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
    """A robot's node in the robot's namespace, after the world had a moment to begin."""
    node = Node(
        executable=sys.executable,
        arguments=[str(HERE / "follower_node.py")],
        remappings=[("front/odom", f"/robot{number - 1}/odom")],
        parameters=[{"use_sim_time": True, "gap": GAP}],
        output="screen",
    )
    return GroupAction([PushRosNamespace(f"robot{number}"), TimerAction(period=0.5, actions=[node])])


def bridge(count):
    """One bridge for all: the clock once, and the two topics of each robot."""
    arguments, remappings = ["/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock"], []
    for number in range(1, count + 1):
        gazebo, ros = f"/model/robot{number}", f"/robot{number}"
        arguments.append(f"{gazebo}/cmd_vel@geometry_msgs/msg/Twist]gz.msgs.Twist")
        arguments.append(f"{gazebo}/odometry@nav_msgs/msg/Odometry[gz.msgs.Odometry")
        remappings += [(f"{gazebo}/cmd_vel", f"{ros}/cmd_vel"), (f"{gazebo}/odometry", f"{ros}/odom")]
    return Node(package="ros_gz_bridge", executable="parameter_bridge", arguments=arguments, remappings=remappings)


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
