"""Starts Gazebo's server with a running world: `world_sdf_file:=empty.sdf`, or its SDF text as `world_sdf_string`."""

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
    parameters = [
        {
            "world_sdf_file": _value("world_sdf_file", str),
            "world_sdf_string": _value("world_sdf_string", str),
            "initial_sim_time": _value("initial_sim_time", float),
            "verbosity_level": _value("verbosity_level", int),
        }
    ]
    server = ComposableNode(package="ros_gz_sim", plugin="ros_gz_sim::GzServer", parameters=parameters)
    return LaunchDescription(
        [
            DeclareLaunchArgument("world_sdf_file", default_value="", description="World to simulate"),
            DeclareLaunchArgument("world_sdf_string", default_value="", description="SDF text of the world"),
            DeclareLaunchArgument(
                "container_name", default_value="ros_gz_container", description="Name of the container, if composed"
            ),
            DeclareLaunchArgument(
                "create_own_container", default_value="False", description="Whether a container is started, if composed"
            ),
            DeclareLaunchArgument(
                "use_composition",
                default_value="False",
                description="Whether the server runs in a container (here as a process of its own)",
            ),
            DeclareLaunchArgument("initial_sim_time", default_value="0.0", description="Initial simulation time, s"),
            DeclareLaunchArgument("verbosity_level", default_value="1", description="Verbosity: 0 to 4"),
            Node(
                condition=UnlessCondition(composed),
                package="ros_gz_sim",
                executable="gzserver",
                output="screen",
                parameters=parameters,
            ),
            ComposableNodeContainer(
                condition=IfCondition(AndSubstitution(composed, own_container)),
                name=LaunchConfiguration("container_name"),
                output="screen",
                composable_node_descriptions=[server],
            ),
            LoadComposableNodes(
                condition=IfCondition(AndSubstitution(composed, NotSubstitution(own_container))),
                target_container=LaunchConfiguration("container_name"),
                composable_node_descriptions=[server],
            ),
        ]
    )


def _value(name: str, kind: type) -> ParameterValue:
    return ParameterValue(LaunchConfiguration(name), value_type=kind)
