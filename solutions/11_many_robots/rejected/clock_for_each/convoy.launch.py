"""Starts a field and a convoy of robots: ros2 launch convoy.launch.py robots:=3"""

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


def robot(number):
    """Everything that one robot of the convoy needs."""
    name = f"robot{number}"
    actions = [
        Node(
            package="ros_gz_sim",
            executable="create",
            arguments=["-file", str(HERE / "robot.sdf"), "-name", name, "-x", str(-GAP * (number - 1)), "-z", "0.01"],
        ),
        Node(
            package="ros_gz_bridge",
            executable="parameter_bridge",
            namespace=name,
            arguments=[
                "/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock",
                f"/model/{name}/cmd_vel@geometry_msgs/msg/Twist]gz.msgs.Twist",
                f"/model/{name}/odometry@nav_msgs/msg/Odometry[gz.msgs.Odometry",
            ],
            remappings=[(f"/model/{name}/cmd_vel", f"/{name}/cmd_vel"), (f"/model/{name}/odometry", f"/{name}/odom")],
        ),
    ]
    if number > 1:
        follower = [sys.executable, str(HERE / "follower_node.py"), "--ros-args", "-r", f"__ns:=/{name}"]
        follower += ["-r", f"front/odom:=/robot{number - 1}/odom", "-p", "use_sim_time:=true", "-p", f"gap:={GAP}"]
        actions.append(ExecuteProcess(cmd=follower, output="screen"))
    return actions


def convoy(context):
    count = int(LaunchConfiguration("robots").perform(context))
    return [action for number in range(1, count + 1) for action in robot(number)]


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
