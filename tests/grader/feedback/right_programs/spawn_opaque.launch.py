# Everything in one function that runs when the launch runs; the bridge gets a file that is written then.
import subprocess
import tempfile
from pathlib import Path

import yaml
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription, OpaqueFunction
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

here = Path(__file__).resolve().parent

TOPICS = [
    ("/clock", "rosgraph_msgs/msg/Clock", "/clock", "gz.msgs.Clock", "GZ_TO_ROS"),
    ("/cmd_vel", "geometry_msgs/msg/Twist", "/model/scout/cmd_vel", "gz.msgs.Twist", "ROS_TO_GZ"),
    ("/scan", "sensor_msgs/msg/LaserScan", "/model/scout/scan", "gz.msgs.LaserScan", "GZ_TO_ROS"),
    ("/joint_states", "sensor_msgs/msg/JointState", "/model/scout/joint_states", "gz.msgs.Model", "GZ_TO_ROS"),
]
KEYS = ["ros_topic_name", "ros_type_name", "gz_topic_name", "gz_type_name", "direction"]


def bring_up(context):
    args = context.launch_configurations
    urdf = subprocess.run(["xacro", str(here / "robot.urdf.xacro")], check=True, capture_output=True, text=True).stdout
    config = Path(tempfile.mkdtemp()) / "bridge.yaml"
    config.write_text(yaml.safe_dump([dict(zip(KEYS, row)) for row in TOPICS]))
    gz_sim = Path(get_package_share_directory("ros_gz_sim"), "launch", "gz_sim.launch.py")
    return [
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource(str(gz_sim)),
            launch_arguments=[("gz_args", f"-s -r {args['world']}")],
        ),
        Node(
            package="ros_gz_bridge",
            executable="parameter_bridge",
            parameters=[{"config_file": str(config)}],
        ),
        Node(
            package="robot_state_publisher",
            executable="robot_state_publisher",
            parameters=[{"robot_description": ParameterValue(urdf, value_type=str)}, {"use_sim_time": True}],
        ),
        Node(
            package="ros_gz_sim",
            executable="create",
            arguments=[
                "-name",
                "scout",
                "-string",
                urdf,
                "-x",
                args["x"],
                "-y",
                args["y"],
                "-z",
                "0.08",
                "-Y",
                args["yaw"],
            ],
        ),
    ]


def generate_launch_description():
    return LaunchDescription(
        [DeclareLaunchArgument("world", default_value=str(here / "yard.sdf"))]
        + [DeclareLaunchArgument(name, default_value="0.0") for name in ("x", "y", "yaw")]
        + [OpaqueFunction(function=bring_up)]
    )
