"""An import of what is not installed says what it is and what to do; nothing else changes."""

import importlib
import importlib.util
import subprocess
import sys

import pytest

from gz_course.sim.ros.prefix.package_advice import advice


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("nav2_simple_commander", "servers of Nav2"),
        ("moveit", "MoveIt is not in this course"),
        ("rqt_gui_py", "rqt and its windows"),
        ("rospy", "belongs to ROS 1"),
        ("gazebo_ros", "Gazebo Classic"),
        ("moveit_msgs", "colcon build, .* ros-jazzy-moveit-msgs"),
        ("tf2_kdl", "sudo apt install ros-jazzy-tf2-kdl"),
        ("grid_map_msgs", "clone it into a workspace, .* sudo apt install ros-jazzy-grid-map-msgs"),
        ("py_trees", "pip install py-trees installs it; .* ros-jazzy-py-trees"),
        ("urdf_parser_py", "pip install urdf-parser-py installs it; .* ros-jazzy-urdfdom-py"),
        ("ros2_numpy", "point_cloud2 and cv_bridge"),
        ("my_robot_interfaces", "colcon build its workspace"),
    ],
)
def test_the_error_says_what_to_do(name, words):
    with pytest.raises(ModuleNotFoundError, match=f"^No module named '{name}': .*{words}") as caught:
        importlib.import_module(f"{name}.robot_navigator")
    assert caught.value.name == name
    assert importlib.util.find_spec(name) is None, "who asks for it is told that it is not there"


def test_other_names_have_the_error_of_python():
    with pytest.raises(ModuleNotFoundError, match=r"^No module named 'surely_not_there'$"):
        importlib.import_module("surely_not_there")
    with pytest.raises(ModuleNotFoundError, match=r"^No module named 'yaml\.cv2'$"):
        importlib.import_module("yaml.cv2")


@pytest.mark.parametrize("name", ["cv2", "scipy"])
def test_what_the_chapters_bring_is_named(name):
    assert advice(name) == "pip install 'gz-ros2-course[chapters]' installs it"


def test_every_python_of_the_environment_says_it(tmp_path):
    (tmp_path / "node.py").write_text("try:\n    import cv2_of_nobody\nexcept ImportError:\n    import px4_msgs.msg\n")
    done = subprocess.run([sys.executable, "node.py"], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.stderr.splitlines()[-1].startswith("ModuleNotFoundError: No module named 'px4_msgs': its messages come")
