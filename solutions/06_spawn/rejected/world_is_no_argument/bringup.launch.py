"""Starts a world, puts the robot into it, and connects it with ROS."""

from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

HERE = Path(__file__).parent
BRIDGES = [
    "/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock",
    "/model/scout/cmd_vel@geometry_msgs/msg/Twist]gz.msgs.Twist",
    "/model/scout/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan",
    "/model/scout/joint_states@sensor_msgs/msg/JointState[gz.msgs.Model",
]


def generate_launch_description():
    description = Command(["xacro ", str(HERE / "robot.urdf.xacro")])
    gz_sim = PathJoinSubstitution([FindPackageShare("ros_gz_sim"), "launch", "gz_sim.launch.py"])
    return LaunchDescription(
        [
            DeclareLaunchArgument("world", default_value=str(HERE / "yard.sdf"), description="World file"),
            DeclareLaunchArgument("x", default_value="0.0", description="Where the robot starts [m]"),
            DeclareLaunchArgument("y", default_value="0.0", description="Where the robot starts [m]"),
            DeclareLaunchArgument("yaw", default_value="0.0", description="Where it looks at first [rad]"),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(gz_sim),
                launch_arguments={"world": LaunchConfiguration("world")}.items(),
            ),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[{"robot_description": ParameterValue(description, value_type=str), "use_sim_time": True}],
                output="screen",
            ),
            Node(
                package="ros_gz_sim",
                executable="create",
                arguments=[
                    *("-topic", "/robot_description", "-name", "scout", "-z", "0.02"),
                    *("-x", LaunchConfiguration("x")),
                    *("-y", LaunchConfiguration("y")),
                    *("-Y", LaunchConfiguration("yaw")),
                ],
                output="screen",
            ),
            Node(
                package="ros_gz_bridge",
                executable="parameter_bridge",
                arguments=BRIDGES,
                remappings=[
                    ("/model/scout/cmd_vel", "/cmd_vel"),
                    ("/model/scout/scan", "/scan"),
                    ("/model/scout/joint_states", "/joint_states"),
                ],
                output="screen",
            ),
        ]
    )
