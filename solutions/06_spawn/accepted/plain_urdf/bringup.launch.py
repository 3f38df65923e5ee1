"""gz sim without an include, the robot as a text that Python has read, the bridges in a parameter file."""

from pathlib import Path

import xacro
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, RegisterEventHandler
from launch.event_handlers import OnProcessExit
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node, SetParameter

HERE = Path(__file__).resolve().parent


def generate_launch_description():
    robot = xacro.process_file(str(HERE / "robot.urdf.xacro")).toxml()
    create = Node(
        package="ros_gz_sim",
        executable="create",
        parameters=[
            {
                "string": robot,
                "name": "scout",
                "x": LaunchConfiguration("x"),
                "y": LaunchConfiguration("y"),
                "z": 0.08,
                "Y": LaunchConfiguration("yaw"),
            }
        ],
    )
    bridge = Node(
        package="ros_gz_bridge",
        executable="parameter_bridge",
        arguments=[
            "/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock",
            "/model/scout/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan",
            "/model/scout/joint_states@sensor_msgs/msg/JointState[gz.msgs.Model",
            "/model/scout/cmd_vel@geometry_msgs/msg/Twist]gz.msgs.Twist",
            *("--ros-args", "-r", "/model/scout/scan:=/scan", "-r", "/model/scout/cmd_vel:=/cmd_vel"),
            *("-r", "/model/scout/joint_states:=/joint_states"),
        ],
    )
    return LaunchDescription(
        [
            SetParameter("use_sim_time", True),
            *(DeclareLaunchArgument(name, default_value="0") for name in ("x", "y", "yaw")),
            DeclareLaunchArgument("world", default_value=str(HERE / "yard.sdf")),
            ExecuteProcess(cmd=["gz", "sim", "-s", "-r", "-v", "2", LaunchConfiguration("world")]),
            create,
            RegisterEventHandler(OnProcessExit(target_action=create, on_exit=[bridge])),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[{"robot_description": robot}],
            ),
        ]
    )
