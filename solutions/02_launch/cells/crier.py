from launch import LaunchDescription
from launch.actions import ExecuteProcess
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription(
        [
            ExecuteProcess(
                cmd=["gz", "sim", "-s", "-r", "lidar_room.sdf"],
                output="screen",
            ),
            Node(
                package="ros_gz_bridge",
                executable="parameter_bridge",
                parameters=[{"config_file": "bridge.yaml"}],
                output="screen",
            ),
            ExecuteProcess(
                cmd=["python3", "town_crier.py", "--ros-args", "-p", "use_sim_time:=true"],
                output="screen",
            ),
        ]
    )
