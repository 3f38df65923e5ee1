"""The actions of ros_gz in launch files of Python, XML and YAML: what they include, with which arguments."""

import pytest
from ros_gz_bridge.actions import RosGzBridge
from ros_gz_sim.actions import GzServer, GzSpawnModel

from gz_course.sim.ros.launch import LaunchContext
from gz_course.sim.ros.launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from gz_course.sim.ros.launch.launch_description_sources import AnyLaunchDescriptionSource
from gz_course.sim.ros.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

ACTIONS = {
    "gz_server": (GzServer, {"world_sdf_file": "empty.sdf", "use_composition": "True"}),
    "gz_spawn_model": (GzSpawnModel, {"file": "robot.sdf", "x": "1.5", "yaw": "0.5"}),
    "ros_gz_bridge": (RosGzBridge, {"bridge_name": "b", "config_file": "b.yaml"}),
}
CALLED = {"roll": "R", "pitch": "P", "yaw": "Y"}


def included(action):
    """Return the name of the launch file, its given arguments as text, and those that it declares."""
    context = LaunchContext()
    (include,) = action.execute(context)
    assert isinstance(include, IncludeLaunchDescription)
    text = lambda value: perform_substitutions(context, normalize_to_list_of_substitutions(value))  # noqa: E731
    description = include.launch_description_source.get_launch_description(context)
    declared = {each.name for each in description.entities if isinstance(each, DeclareLaunchArgument)}
    path = include.launch_description_source.location
    return path.rpartition("/")[2], {text(name): text(value) for name, value in include.launch_arguments}, declared


@pytest.mark.parametrize("name", ACTIONS)
@pytest.mark.parametrize("kind", ["py", "xml", "yaml"])
def test_an_action_is_its_launch_file(tmp_path, name, kind):
    made, given = ACTIONS[name]
    if kind == "py":
        action = made(**given)
    else:
        attributes = " ".join(f'{key}="{value}"' for key, value in given.items())
        lines = "".join(f"      {key}: '{value}'\n" for key, value in given.items())
        text = {"xml": f"<launch><{name} {attributes}/></launch>", "yaml": f"launch:\n  - {name}:\n{lines}"}[kind]
        (tmp_path / f"a.launch.{kind}").write_text(text)
        source = AnyLaunchDescriptionSource(str(tmp_path / f"a.launch.{kind}"))
        (action,) = source.get_launch_description(LaunchContext()).entities
    file, arguments, declared = included(action)
    assert file == f"{name}.launch.py"
    assert {CALLED.get(key, key): value for key, value in given.items()}.items() <= arguments.items()
    assert arguments.keys() == declared


def test_an_argument_that_is_missing_or_wrong_is_named():
    with pytest.raises(TypeError, match="RosGzBridge needs the argument 'config_file'"):
        RosGzBridge(bridge_name="b")
    with pytest.raises(TypeError, match="GzServer has no argument 'world_sdf'; did you mean 'world_sdf_file'"):
        GzServer(world_sdf="empty.sdf")
