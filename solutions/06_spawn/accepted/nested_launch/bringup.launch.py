"""The simulator has a launch of its own, started as in a shell: `ros2 launch ros_gz_sim gz_sim.launch.py`."""

from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import Command, LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

HERE = Path(__file__).parent
MODEL = "/model/scout"
BRIDGES = [
    "/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock",
    f"{MODEL}/cmd_vel@geometry_msgs/msg/Twist]gz.msgs.Twist",
    f"{MODEL}/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan",
    f"{MODEL}/joint_states@sensor_msgs/msg/JointState[gz.msgs.Model",
]


def generate_launch_description():
    world = LaunchConfiguration("world")
    description = Command(["xacro ", str(HERE / "robot.urdf.xacro")])
    place = ["-x", LaunchConfiguration("x"), "-y", LaunchConfiguration("y"), "-Y", LaunchConfiguration("yaw")]
    return LaunchDescription(
        [
            DeclareLaunchArgument("world", default_value=str(HERE / "yard.sdf")),
            DeclareLaunchArgument("x", default_value="0.0"),
            DeclareLaunchArgument("y", default_value="0.0"),
            DeclareLaunchArgument("yaw", default_value="0.0"),
            ExecuteProcess(
                cmd=["ros2", "launch", "ros_gz_sim", "gz_sim.launch.py", ["gz_args:=-s -r ", world]], output="screen"
            ),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[{"robot_description": ParameterValue(description, value_type=str), "use_sim_time": True}],
            ),
            Node(
                package="ros_gz_sim",
                executable="create",
                arguments=["-topic", "/robot_description", "-name", "scout", "-z", "0.02", *place],
            ),
            Node(
                package="ros_gz_bridge",
                executable="parameter_bridge",
                arguments=BRIDGES,
                remappings=[(f"{MODEL}/{name}", f"/{name}") for name in ("cmd_vel", "scan", "joint_states")],
            ),
        ]
    )
