"""The commands of the shell: bridge and `create` are started with `ros2 run`, the description comes from the file."""

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


def ros2_run(package, executable, *arguments):
    return ExecuteProcess(cmd=["ros2", "run", package, executable, *arguments], output="screen")


def generate_launch_description():
    description = Command(["xacro ", str(HERE / "robot.urdf.xacro")])
    place = [
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
            ExecuteProcess(cmd=["gz", "sim", "-s", "-r", LaunchConfiguration("world")], output="screen"),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[{"robot_description": ParameterValue(description, value_type=str), "use_sim_time": True}],
            ),
            ros2_run("ros_gz_sim", "create", "-topic", "/robot_description", "-name", "scout", "-z", "0.02", *place),
            ros2_run("ros_gz_bridge", "parameter_bridge", *BRIDGES, "--ros-args", *NAMES),
        ]
    )
