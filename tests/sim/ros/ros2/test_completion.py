"""The completions at a Tab."""

import subprocess
import sys
from pathlib import Path

import pytest

from gz_course.sim.ros.ros2.command_line import COMMANDS, found


def test_commands_verbs_and_options(offered):
    assert offered("") == list(found(COMMANDS))
    assert offered("to") == ["topic"]
    assert offered("topic", "e") == ["echo"]
    assert offered("topic", "echo", "--qos-rel") == ["--qos-reliability"]
    assert "reliable" in offered("topic", "echo", "--qos-reliability", "")
    assert offered("daemon", "st") == ["start", "status", "stop"]


@pytest.mark.parametrize("words", [["nope", ""], ["topic", "nope", ""], ["run", "--prefix", ""], ["pkg", "list", "x"]])
def test_where_nothing_is_known_nothing_is_offered(offered, words):
    assert offered(*words) == []


def test_packages_executables_and_interfaces(offered):
    assert offered("run", "ros_gz_b") == ["ros_gz_bridge"]
    assert {"lint", "parameter_bridge"} <= set(offered("run", "--prefix", "gdb", "ros_gz_bridge", ""))
    assert offered("interface", "show", "std_msgs/msg/Bo") == ["std_msgs/msg/Bool"]
    fibonacci = "example_interfaces/action/Fibonacci"
    assert offered("action", "find", fibonacci[:-3]) == [fibonacci]
    assert offered("action", "send_goal", "/no_such_action", fibonacci, "") == [r"\{order:\ 0\}"]
    assert offered("topic", "pub", "/no_such_topic", "geometry_msgs/msg/Twist", "") == [
        r"\{linear:\ \{x:\ 0.0,\ y:\ 0.0,\ z:\ 0.0\},\ angular:\ \{x:\ 0.0,\ y:\ 0.0,\ z:\ 0.0\}\}"
    ]


def test_launch_files_and_their_arguments(offered, tmp_path):
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


def test_names_of_the_live_graph(offered, robot):
    assert offered("topic", "echo", "/stam") == ["/stamped"]
    assert offered("topic", "pub", "/stamped", "geo") == ["geometry_msgs/msg/PointStamped"]
    assert offered("node", "info", "/robot/dr") == ["/robot/driver"]
    assert offered("service", "call", "/robot/en") == ["/robot/enable"]
    assert offered("service", "call", "/robot/enable", "") == ["std_srvs/srv/SetBool"]
    assert offered("param", "get", "/robot/driver", "sp") == ["speed"]


def test_bash_completes():
    asked = """
eval "$(register-python-argcomplete ros2)"
tab() { COMP_LINE="$1"; COMP_POINT=${#1}; COMPREPLY=(); _python_argcomplete ros2; printf '<%s>\\n' "${COMPREPLY[@]}"; }
tab 'ros2 service call /x std_srvs/srv/SetBool '
tab 'ros2 topic ec'
tab 'ros2 launch ros_gz_sim gz_sim.launch.py gz_a'
tab 'ros2 nope x'
complete -p ros2
"""
    command = Path(sys.executable).parent
    done = subprocess.run(
        ["bash", "-c", asked], env={"PATH": f"{command}:/usr/bin:/bin"}, capture_output=True, text=True, timeout=120
    )
    *lines, registered = done.stdout.splitlines()
    assert lines == [r"<\{data:\ false\} >", "<echo >", "<gz_args:=>", "<>"]
    assert registered.endswith("-F _python_argcomplete ros2")
