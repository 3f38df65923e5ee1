"""The launch files of ros_gz_sim and ros_gz_bridge in the ament prefix."""

import os
import signal
import subprocess
import sys
import uuid
from pathlib import Path

import psutil
import pytest

from gz_course.sim.ros.launch import LaunchContext
from gz_course.sim.ros.launch.launch_description_sources import get_launch_description_from_python_launch_file
from gz_course.sim.ros.launch_ros.substitutions import FindPackageShare
from gz_course.sim.ros.prefix import local_setup
from gz_course.tests.sim.command_line import command_of
from gz_course.tests.warm_process import WarmPopen

SHARE = Path(local_setup.PREFIX) / "share"
FILES = sorted(SHARE.glob("*/launch/*.launch.py"))
# The launch files of the packages of these names on a full installation.
ARGUMENTS = {
    "gz_spawn_model.launch.py": [
        *("world", "file", "model_string", "topic", "entity_name", "allow_renaming", "x", "y", "z", "R", "P", "Y"),
    ],
    "gz_sim.launch.py": ["gz_args", "gz_version", "ign_args", "ign_version", "debugger", "on_exit_shutdown"],
    "ros_gz_bridge.launch.py": [
        *("bridge_name", "config_file", "container_name", "create_own_container", "namespace", "use_composition"),
        *("use_respawn", "log_level"),
    ],
}


@pytest.fixture
def start(tmp_path):
    """Run one of the launch files as a process whose output is read by line and which ends with the test.

    All processes of a test share a partition.
    """
    running = []
    partition = uuid.uuid4().hex

    def start(*arguments):
        running.append(
            WarmPopen(
                [sys.executable, "-m", "gz_course.sim.ros.ros2", "launch", *arguments],
                env={
                    **os.environ,
                    "GZ_IP": "127.0.0.1",
                    "GZ_PARTITION": partition,
                    "ROS_LOG_DIR": str(tmp_path),
                    "ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF",
                },
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                cwd=tmp_path,
            )
        )
        return running[-1]

    yield start
    for process in running:
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=120)


def lines_until(process, words):
    lines = []
    for line in process.stdout:
        lines.append(line)
        if words in line:
            return "".join(lines)
        if "process has died" in line:
            break
    raise AssertionError(f"no {words!r} in {''.join(lines)}")


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_every_launch_file_has_described_arguments(path):
    arguments = get_launch_description_from_python_launch_file(str(path)).get_launch_arguments()
    assert all(argument.description != "no description given" for argument in arguments)
    if path.name in ARGUMENTS:
        assert [argument.name for argument in arguments] == ARGUMENTS[path.name]


def test_they_are_found_by_their_package():
    assert Path(FindPackageShare("ros_gz_sim").perform(LaunchContext())) == SHARE / "ros_gz_sim"


def test_gazebo_gets_its_words_as_a_shell_reads_them(start, tmp_path):
    world = '<sdf version="1.9"><world name="small"><physics type="ode"/></world></sdf>'
    (tmp_path / "small world.sdf").write_text(world)
    process = start("ros_gz_sim", "gz_sim.launch.py", "gz_args:=-s -v3 $PWD/'small world.sdf'")
    said = lines_until(process, "is paused")
    assert "[gazebo-1] [Msg] world 'small' is loaded" in said
    process.send_signal(signal.SIGINT)
    rest, _ = process.communicate(timeout=120)
    assert process.returncode == 0
    assert "[INFO] [gazebo-1]: process has finished cleanly" in rest


@pytest.mark.parametrize(("value", "ends"), [("true", True), ("false", False)])
def test_the_end_of_gazebo_may_end_the_launch(start, tmp_path, value, ends):
    arguments = ["gz_args:=-r -s empty.sdf --iterations 1", f"on_exit_shutdown:={value}"]
    output, _ = start("ros_gz_sim", "gz_sim.launch.py", *arguments).communicate(timeout=120)
    assert ("process[gazebo-1] was required: shutting down launched system" in output) is ends


def test_gazebo_can_be_started_with_a_prefix(start):
    prefix = ["--launch-prefix", "env GZ_PARTITION=other"]
    process = start(*prefix, "ros_gz_sim", "gz_sim.launch.py", "gz_args:=-s empty.sdf")
    lines_until(process, "is paused")
    children = psutil.Process(process.pid).children()
    (gazebo,) = [each for each in children if "orphan_watch" not in command_of(each)]
    assert gazebo.environ()["GZ_PARTITION"] == "other"


def test_old_arguments_work_and_are_told(start):
    process = start("ros_gz_sim", "gz_sim.launch.py", "ign_args:=-s empty.sdf")
    assert "'ign_args' is deprecated: use 'gz_args'" in lines_until(process, "is paused")


@pytest.mark.proof
def test_simulator_and_bridge_together(start, tmp_path):
    (tmp_path / "bridge.yaml").write_text(
        "- topic_name: /clock\n  ros_type_name: rosgraph_msgs/msg/Clock\n  gz_type_name: gz.msgs.Clock\n"
        "  direction: GZ_TO_ROS\n"
    )
    arguments = ["bridge_name:=my_bridge", "config_file:=bridge.yaml", "namespace:=/ns"]
    process = start("ros_gz_sim", "ros_gz_sim.launch.py", "world_sdf_file:=lidar_room.sdf", *arguments)
    assert "[ns.my_bridge]: ready: 1 bridge" in lines_until(process, "ready:")


@pytest.mark.proof
def test_a_server_from_a_text_and_a_model_spawned_into_it(start):
    text = "<sdf version='1.9'><world name='small'/></sdf>"
    arguments = [f"world_sdf_string:={text}", "initial_sim_time:=5.0", "verbosity_level:=3"]
    server = start("ros_gz_sim", "gz_server.launch.py", *arguments)
    lines_until(server, "world 'small' is loaded")
    model = "<sdf version='1.9'><model name='m'><static>true</static><link name='l'/></model></sdf>"
    arguments = ["world:=small", f"model_string:={model}", "entity_name:=here", "x:=1.5", "Y:=1.5"]
    output, _ = start("ros_gz_sim", "gz_spawn_model.launch.py", *arguments).communicate(timeout=120)
    assert "Entity creation successful in world 'small'" in output
    output, _ = start("ros_gz_sim", "gz_spawn_model.launch.py", *arguments).communicate(timeout=120)
    assert "already has something called 'here'" in output
    assert "process has died" in output


@pytest.mark.proof
def test_a_model_with_its_bridge(start, tmp_path):
    (tmp_path / "bridge.yaml").write_text(
        "- topic_name: /clock\n  ros_type_name: rosgraph_msgs/msg/Clock\n  gz_type_name: gz.msgs.Clock\n"
        "  direction: GZ_TO_ROS\n"
    )
    server = start("ros_gz_sim", "gz_server.launch.py", "world_sdf_file:=empty.sdf", "verbosity_level:=3")
    lines_until(server, "world 'empty' is loaded")
    arguments = ["bridge_name:=my_bridge", "config_file:=bridge.yaml", "file:=model://crate"]
    process = start("ros_gz_sim", "ros_gz_spawn_model.launch.py", *arguments)
    waiting = {"ready: 1 bridge", "Entity creation successful in world 'empty'"}
    for line in process.stdout:
        assert "process has died" not in line
        waiting = {words for words in waiting if words not in line}
        if not waiting:
            break
    assert not waiting


def test_what_is_composed_runs_as_a_process_of_its_own(start):
    arguments = ["world_sdf_file:=empty.sdf", "use_composition:=True", "create_own_container:=True"]
    process = start("ros_gz_sim", "gz_server.launch.py", *arguments, "verbosity_level:=3")
    said = lines_until(process, "world 'empty' is loaded")
    assert "the nodes of the container 'ros_gz_container' run as processes of their own (1)" in said
