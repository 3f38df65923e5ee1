"""Starts the bridge between Gazebo and ROS 2 with a configuration file.

`ros2 launch ros_gz_bridge ros_gz_bridge.launch.py bridge_name:=my_bridge config_file:=bridge.yaml`
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import AndSubstitution, LaunchConfiguration, NotSubstitution
from launch_ros.actions import ComposableNodeContainer, LoadComposableNodes, Node
from launch_ros.descriptions import ComposableNode
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description() -> LaunchDescription:
    composed = LaunchConfiguration("use_composition")
    own_container = LaunchConfiguration("create_own_container")
    parameters = [{"config_file": ParameterValue(LaunchConfiguration("config_file"), value_type=str)}]
    bridge = ComposableNode(
        package="ros_gz_bridge",
        plugin="ros_gz_bridge::RosGzBridge",
        name=LaunchConfiguration("bridge_name"),
        namespace=LaunchConfiguration("namespace"),
        parameters=parameters,
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument("bridge_name", description="Name of the bridge's node"),
            DeclareLaunchArgument("config_file", description="YAML file that lists the bridges"),
            DeclareLaunchArgument(
                "container_name", default_value="ros_gz_container", description="Name of the container, if composed"
            ),
            DeclareLaunchArgument(
                "create_own_container", default_value="False", description="Whether a container is started, if composed"
            ),
            DeclareLaunchArgument("namespace", default_value="", description="Namespace of the bridge's node"),
            DeclareLaunchArgument(
                "use_composition",
                default_value="False",
                description="Whether the bridge runs in a container (here as a process of its own)",
            ),
            DeclareLaunchArgument(
                "use_respawn", default_value="False", description="Whether the bridge is restarted after it has ended"
            ),
            DeclareLaunchArgument("log_level", default_value="info", description="Log level of the bridge"),
            Node(
                condition=UnlessCondition(composed),
                package="ros_gz_bridge",
                executable="parameter_bridge",
                name=LaunchConfiguration("bridge_name"),
                namespace=LaunchConfiguration("namespace"),
                output="screen",
                respawn=LaunchConfiguration("use_respawn"),
                respawn_delay=2.0,
                parameters=parameters,
                ros_arguments=["--log-level", LaunchConfiguration("log_level")],
            ),
            ComposableNodeContainer(
                condition=IfCondition(AndSubstitution(composed, own_container)),
                name=LaunchConfiguration("container_name"),
                output="screen",
                composable_node_descriptions=[bridge],
            ),
            LoadComposableNodes(
                condition=IfCondition(AndSubstitution(composed, NotSubstitution(own_container))),
                target_container=LaunchConfiguration("container_name"),
                composable_node_descriptions=[bridge],
            ),
        ]
    )
