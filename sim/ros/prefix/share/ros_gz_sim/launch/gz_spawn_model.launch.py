"""Creates a model in a running world, like `ros2 run ros_gz_sim create`.

`ros2 launch ros_gz_sim gz_spawn_model.launch.py world:=empty file:=box.sdf entity_name:=box x:=1.0 z:=0.5`
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

TEXTS = {
    "world": "World to create it in; empty: the one that runs",
    "file": "SDF, URDF or xacro file, or model:// or package:// URI",
    "model_string": "SDF or URDF text",
    "topic": "Topic that carries the text, such as /robot_description",
    "entity_name": "Name in the world; empty: the one in the file",
}
POSE = dict.fromkeys("xyz", "Position, m") | {"R": "Roll, rad", "P": "Pitch, rad", "Y": "Yaw, rad"}
PARAMETERS = {"model_string": "string", "entity_name": "name"}


def generate_launch_description() -> LaunchDescription:
    values = {PARAMETERS.get(name, name): _value(name, str) for name in TEXTS}
    values |= {name: _value(name, float) for name in POSE}
    return LaunchDescription(
        [
            *(DeclareLaunchArgument(name, default_value="", description=text) for name, text in TEXTS.items()),
            DeclareLaunchArgument(
                "allow_renaming", default_value="False", description="Whether a number is appended to a taken name"
            ),
            *(DeclareLaunchArgument(name, default_value="0.0", description=text) for name, text in POSE.items()),
            Node(
                package="ros_gz_sim",
                executable="create",
                output="screen",
                parameters=[values | {"allow_renaming": _value("allow_renaming", bool)}],
            ),
        ]
    )


def _value(name: str, kind: type) -> ParameterValue:
    return ParameterValue(LaunchConfiguration(name), value_type=kind)
