# The convoy with one bridge for everything: its configuration is written to a temporary file when the launch runs.
import json
import os
import sys
import tempfile

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, GroupAction, IncludeLaunchDescription, OpaqueFunction
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch_ros.actions import Node

here = os.path.dirname(os.path.realpath(__file__))


def entry(ros, ros_type, gz, gz_type, direction):
    return {
        "ros_topic_name": ros,
        "ros_type_name": ros_type,
        "gz_topic_name": gz,
        "gz_type_name": gz_type,
        "direction": direction,
    }


def everything(context):
    names = ["robot%d" % (i + 1) for i in range(int(context.launch_configurations["robots"]))]

    entries = [entry("/clock", "rosgraph_msgs/msg/Clock", "/clock", "gz.msgs.Clock", "GZ_TO_ROS")]
    for n in names:
        entries += [
            entry(f"/{n}/cmd_vel", "geometry_msgs/msg/Twist", f"/model/{n}/cmd_vel", "gz.msgs.Twist", "ROS_TO_GZ"),
            entry(f"/{n}/odom", "nav_msgs/msg/Odometry", f"/model/{n}/odometry", "gz.msgs.Odometry", "GZ_TO_ROS"),
        ]
    config = os.path.join(tempfile.mkdtemp(prefix="convoy"), "bridge.yaml")
    with open(config, "w") as f:
        json.dump(entries, f, indent=1)  # JSON is YAML

    actions = [Node(package="ros_gz_bridge", executable="parameter_bridge", parameters=[{"config_file": config}])]
    x = 0.0
    for n in names:
        actions.append(
            Node(
                package="ros_gz_sim",
                executable="create",
                arguments=["-name", n, "-file", os.path.join(here, "robot.sdf"), "-x", f"{x:.2f}"],
            )
        )
        x -= 1.2
    for front, n in zip(names, names[1:]):
        actions.append(
            ExecuteProcess(
                cmd=[
                    sys.executable,
                    os.path.join(here, "follower_node.py"),
                    "--ros-args",
                    "-r",
                    f"__ns:=/{n}",
                    "-r",
                    f"ahead:=/{front}/odom",
                    "-p",
                    "use_sim_time:=true",
                ]
            )
        )
    return [GroupAction(actions)]


def generate_launch_description():
    gz_sim = os.path.join(get_package_share_directory("ros_gz_sim"), "launch", "gz_sim.launch.py")
    return LaunchDescription(
        [
            DeclareLaunchArgument("robots", default_value="2"),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(gz_sim),
                launch_arguments=[("gz_args", "-r -s " + os.path.join(here, "field.sdf"))],
            ),
            OpaqueFunction(function=everything),
        ]
    )
