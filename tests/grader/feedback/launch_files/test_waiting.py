"""Programs that the Python of a launch file waits for, so that the launch stands still."""

import pytest

from gz_course.grader.feedback.launch_files import launch_places

FILE = """\
import subprocess, os
from subprocess import check_call

from launch import LaunchDescription
from launch.actions import OpaqueFunction


def make(context):
    COMMAND
    return [Node(package="ros_gz_sim", executable="create", arguments=["-name", "a"])]


def generate_launch_description():
    return LaunchDescription([OpaqueFunction(function=make)])
"""


@pytest.mark.parametrize(
    ("command", "words"),
    [
        ("subprocess.run(['ros2', 'run', 'ros_gz_sim', 'create', '-name', name])", "waits here until create ends"),
        ("check_call(f'ros2 run ros_gz_sim create -name {name}', shell=True)", "waits here until create ends"),
        ("c = ['ros2', 'run']; c += ['ros_gz_sim', 'remove']; subprocess.call(c)", "until remove ends"),
        ("os.system('gz sim -s -r field.sdf')", "until gz sim ends, which never happens"),
        ("subprocess.check_output(['gz', 'service', '-s', '/world/a/create'])", "calls gz service while the launch"),
        ("subprocess.run(['xacro', 'robot.urdf.xacro'], check=True)", ""),
        ("context.run(['ros2', 'run', 'ros_gz_sim', 'create'])", ""),
    ],
)
def test_a_program_that_a_launch_file_waits_for(command, words):
    found = [each["said"] for each in launch_places(FILE.replace("COMMAND", command).encode())["launch_slips"]]
    assert (words in "\n".join(found)) and bool(words) == bool(found), found


def test_what_an_event_starts_may_find_a_simulator():
    command = "subprocess.run(['ros2', 'run', 'ros_gz_sim', 'create'])"
    later = FILE.replace("COMMAND", command).replace("[OpaqueFunction(", "[TimerAction(period=2.0, actions=[]), O(")
    assert not any("waits here" in each["said"] for each in launch_places(later.encode())["launch_slips"])
