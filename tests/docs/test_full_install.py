"""The page on full installations names every command of `gz` and `ros2`, every verb and every program, and no other."""

import re
from pathlib import Path

import pytest
from ament_index_python.packages import get_package_prefix

from gz_course.sim.gz.command import find_commands
from gz_course.sim.ros.ros2.command_line import COMMANDS, found

PAGE = (Path(__file__).parents[2] / "docs" / "full_install.md").read_text()
HERE = [line.split("|")[1] for line in PAGE.splitlines() if line.startswith("| `")]
OURS = (
    "ros_gz_bridge",
    "ros_gz_image",
    "ros_gz_sim",
    "robot_state_publisher",
    "rqt_graph",
    "rviz2",
    "teleop_twist_keyboard",
    "tf2_ros",
    "tf2_tools",
)
WITH_VERBS = [name for name, path in found(COMMANDS).items() if path.is_dir()]


def named_after(*beginning):
    """The words that follow these in the left column: `gz topic -l`, or `ros2 node list`, `info`."""
    words = []
    for cell in HERE:
        codes = re.findall("`([^`]*)`", cell)
        if tuple(codes[0].split()[: len(beginning)]) != beginning:
            continue
        words.append(codes[0].split()[len(beginning)])
        words += [code for code in codes[1:] if re.fullmatch("[a-z_]+", code)]
    return sorted(words)


def test_every_command_of_gazebo_is_named_once():
    assert sorted(set(named_after("gz"))) == sorted(find_commands())


def test_every_command_of_ros_is_named():
    named = {cell.split()[1].strip("`") for cell in HERE if cell.startswith(" `ros2 ")}
    assert named == set(found(COMMANDS))


@pytest.mark.parametrize("command", WITH_VERBS)
def test_every_verb_is_named_once(command):
    assert named_after("ros2", command) == sorted(found(COMMANDS / command))


@pytest.mark.parametrize("package", OURS)
def test_every_program_is_named_once(package):
    programs = sorted(path.name for path in (Path(get_package_prefix(package)) / "lib" / package).iterdir())
    assert named_after("ros2", "run", package) == programs
