"""Shells start the programs: one waits for the bridge, the others become `create` and the simulator."""

from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import Command, LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

HERE = Path(__file__).parent
BRIDGES = [
    "/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock",
    "/model/scout/cmd_vel@geometry_msgs/msg/Twist]gz.msgs.Twist",
    "/model/scout/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan",
    "/model/scout/joint_states@sensor_msgs/msg/JointState[gz.msgs.Model",
]
NAMES = [
    *("-r", "/model/scout/cmd_vel:=/cmd_vel"),
    *("-r", "/model/scout/scan:=/scan"),
    *("-r", "/model/scout/joint_states:=/joint_states"),
]


def shell(command, *words):
    return ExecuteProcess(cmd=["bash", "-c", command, *words], output="screen")


def generate_launch_description():
    description = Command(["xacro ", str(HERE / "robot.urdf.xacro")])
    place = ["-name", "scout", "-z", "0.02"] + [
        word
        for name, option in (("x", "-x"), ("y", "-y"), ("yaw", "-Y"))
        for word in (option, LaunchConfiguration(name))
    ]
    return LaunchDescription(
        [
            DeclareLaunchArgument("world", default_value=str(HERE / "yard.sdf")),
            DeclareLaunchArgument("x", default_value="0.0"),
            DeclareLaunchArgument("y", default_value="0.0"),
            DeclareLaunchArgument("yaw", default_value="0.0"),
            shell("exec gz sim -s -r $0", LaunchConfiguration("world")),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[{"robot_description": ParameterValue(description, value_type=str), "use_sim_time": True}],
            ),
            shell('exec ros2 run "$0" "$@"', "ros_gz_sim", "create", "-topic", "/robot_description", *place),
            shell('ros2 run "$0" "$@"; exit $?', "ros_gz_bridge", "parameter_bridge", *BRIDGES, "--ros-args", *NAMES),
        ]
    )
