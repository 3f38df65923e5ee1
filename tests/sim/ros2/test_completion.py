"""What a Tab offers."""

import subprocess
import sys
from pathlib import Path

import pytest

from gz_course.sim.ros2.command_line import COMMANDS, found
from gz_course.sim.ros2.completion import candidates


def offered(*words):
    return candidates(list(words))


def test_commands_verbs_and_options():
    assert offered("") == list(found(COMMANDS))
    assert offered("to") == ["topic"]
    assert offered("--p") == ["--print-completion"]
    assert offered("--print-completion", "") == ["bash", "zsh"]
    assert offered("topic", "e") == ["echo"]
    assert offered("topic", "echo", "--qos-rel") == ["--qos-reliability"]
    assert "reliable" in offered("topic", "echo", "--qos-reliability", "")
    assert offered("daemon", "st") == ["start", "status", "stop"]


@pytest.mark.parametrize("words", [["nope", ""], ["topic", "nope", ""], ["run", "--prefix", ""], ["pkg", "list", "x"]])
def test_where_nothing_is_known_nothing_is_offered(words):
    assert offered(*words) == []


def test_packages_executables_and_interfaces():
    assert offered("run", "ros_gz_b") == ["ros_gz_bridge"]
    assert {"lint", "parameter_bridge"} <= set(offered("run", "--prefix", "gdb", "ros_gz_bridge", ""))
    assert offered("interface", "show", "std_msgs/msg/Bo") == ["std_msgs/msg/Bool"]
    assert offered("topic", "pub", "/no_such_topic", "geometry_msgs/msg/Twist", "") == [
        "'{linear: {x: 0.0, y: 0.0, z: 0.0}, angular: {x: 0.0, y: 0.0, z: 0.0}}'"
    ]


def test_launch_files_and_their_arguments(tmp_path):
    assert offered("launch", "ros_gz_sim", "gz_si") == ["gz_sim.launch.py"]
    assert "gz_args:=" in offered("launch", "ros_gz_sim", "gz_sim.launch.py", "")
    assert offered("launch", "ros_gz_sim", "gz_sim.launch.py", "on_exit_shutdown:=true", "gz_a") == ["gz_args:="]
    path = tmp_path / "my.launch.py"
    path.write_text(
        "from launch import LaunchDescription\nfrom launch.actions import DeclareLaunchArgument\n"
        "def generate_launch_description():\n    return LaunchDescription([DeclareLaunchArgument('map')])\n"
    )
    assert offered("launch", str(path), "") == ["map:="]
    assert offered("launch", str(path), "map:=a", "") == ["map:="]
    assert offered("launch", "no_such_package", "") == []


def test_names_of_the_live_graph(robot):
    assert offered("topic", "echo", "/stam") == ["/stamped"]
    assert offered("topic", "pub", "/stamped", "geo") == ["geometry_msgs/msg/PointStamped"]
    assert offered("node", "info", "/robot/dr") == ["/robot/driver"]
    assert offered("service", "call", "/robot/en") == ["/robot/enable"]
    assert offered("service", "call", "/robot/enable", "") == ["std_srvs/srv/SetBool"]
    assert offered("param", "get", "/robot/driver", "sp") == ["speed"]


def test_bash_completes(ros2):
    code, script, errors = ros2("--print-completion", "bash")
    assert (code, errors) == (0, "")
    asked = f"""{script}
COMP_WORDS=(ros2 service call /x std_srvs/srv/SetBool ""); COMP_CWORD=5; _ros2; printf '<%s>\\n' "${{COMPREPLY[@]}}"
COMP_WORDS=(ros2 topic ec); COMP_CWORD=2; _ros2; printf '<%s>\\n' "${{COMPREPLY[@]}}"
COMP_WORDS=(ros2 nope x); COMP_CWORD=2; _ros2; echo "${{#COMPREPLY[@]}}"
complete -p ros2
"""
    command = Path(sys.executable).parent
    done = subprocess.run(
        ["bash", "-c", asked], env={"PATH": f"{command}:/usr/bin:/bin"}, capture_output=True, text=True, timeout=120
    )
    *lines, registered = done.stdout.splitlines()
    assert lines == ["<'{data: false}'>", "<echo>", "0"]
    assert registered.endswith("-F _ros2 ros2")


def test_zsh_has_a_script_and_other_shells_a_sentence(ros2):
    assert "compdef _ros2 ros2" in ros2("--print-completion", "zsh")[1]
    assert ros2("--print-completion", "fish") == (
        1,
        "",
        "--print-completion takes the name of the shell: bash or zsh\n",
    )
