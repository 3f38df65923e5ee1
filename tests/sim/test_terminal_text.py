"""No command of ours writes control codes of others to a terminal, whatever names it is given."""

import io
import os
import subprocess
import sys
from importlib.metadata import entry_points
from pathlib import Path

import pytest

from gz_course.sim import terminal_text
from gz_course.sim.ros.rosbag2.definitions import definition
from gz_course.sim.ros.rosbag2.storage.bag_writer import BagWriter
from gz_course.sim.ros.rosbag2.storage.metadata import Topic
from gz_course.sim.terminal_text import printable
from gz_course.tests.sim.ros.rosbag2.bags import CHATTER, string

HOSTILE = "x\x1b]0;owned\x07\x1b[2J\x9b31m\ry\x7f"
BIN = Path(sys.executable).parent
COMMANDS = [
    "gz sdf --check {file}",
    "gz sdf --print {world}",
    "gz sdf --print {named}",
    "gz sim -s -r --iterations 1 {named}",
    "gz sim -s {name}",
    "gz topic -i -t /{name}",
    "gz topic -p x -t /{name} -m {name}",
    "gz service -i -s /{name}",
    "gz msg -i {name}",
    "gz {name}",
    "ros2 bag info {bag}",
    "ros2 bag info {file}",
    "ros2 bag play {bag}",
    "ros2 bag play {bag} --topics /{name}",
    "ros2 topic pub --once /{name} {name}",
    "ros2 param load /n {file}",
    "ros2 interface show {name}",
    "ros2 pkg prefix {name}",
    "ros2 run {name} {name}",
    "ros2 launch {name}",
    "ros2 {name}",
    "course grade {name}",
    "course show {file}",
    "course score {file}",
    "course grade 03 --submission {file}",
    "course grade-all 03 {students} --out {folder}/{name}_grades",
    "course similar 03 {students} --out {folder}/{name}_similar",
    "course init {folder}/{name}_course",
    "course update {folder}/{name}_course",
    "course new {name}",
    "course list {name}",
    "launch_test {name}",
    "launch_test {file}",
    "bridge_types --get-ros-to-gz {name}",
    "bridge_types {name}",
    "ros_gz_bridge_lint {file}",
    "ros_gz_bridge_lint {name}@{name}@{name}",
    "ros_gz_bridge_lint --{name}",
    "parameter_bridge {name}@{name}@{name}",
    "ros2 run rqt_graph rqt_graph --svg {file}/x.svg",
    "ros2 run rqt_graph rqt_graph {name}",
    "ros2 run rviz2 rviz2 --save {file}",
    "ros2 run rviz2 rviz2 --{name}",
    "ros2 run ros_gz_bridge lint {file}",
    "ros2 run ros_gz_bridge bridge_types {name}",
    "ros2 run ros_gz_bridge bridge_node --ros-args -p config_file:={file}",
    "ros2 run ros_gz_bridge parameter_bridge {name}",
    "ros2 run ros_gz_image image_bridge {name} --ros-args -p qos:={name}",
    "ros2 run ros_gz_sim create -file {file}",
    "ros2 run ros_gz_sim create -{name}",
    "ros2 run ros_gz_sim delete_entity --{name}",
    "ros2 run ros_gz_sim gzserver -{name}",
    "ros2 run ros_gz_sim remove -{name}",
    "ros2 run ros_gz_sim set_entity_pose --name {name}",
    "ros2 run ros_gz_sim spawn_entity --{name}",
    "ros2 run robot_state_publisher robot_state_publisher {name}",
    "ros2 run teleop_twist_keyboard teleop_twist_keyboard {name}",
    "ros2 run tf2_ros static_transform_publisher --frame-id {name}",
    "ros2 run tf2_ros tf2_echo {name}",
    "ros2 run tf2_ros tf2_monitor {name}",
    "ros2 run tf2_ros view_frames {name}",
    "ros2 run tf2_tools view_frames {name}",
]
LIBRARY = Path(__file__).parents[2] / "sim/ros/prefix/lib"


@pytest.fixture(scope="module")
def inputs(tmp_path_factory):
    """Return a hostile name, files with hostile names, and files and a bag with hostile content."""
    folder = tmp_path_factory.mktemp("hostile")
    file, world, named = folder / f"{HOSTILE}.sdf", folder / "world.sdf", folder / f"{HOSTILE}_2.sdf"
    file.write_text("<sdf version='1.9'><world name='w'><bad/>")
    name = "a&#x9b;31m"
    inside = f"<include><uri>{name}</uri></include><plugin filename='{name}' name='{name}'/>"
    for each in (world, named):
        each.write_text(f"<sdf version='1.9'><world name='{name}'>{inside}</world></sdf>")
    bag = folder / f"{HOSTILE}_bag"
    writer = BagWriter(bag)
    topic = Topic(f"/{HOSTILE}", CHATTER.type, qos=CHATTER.qos)
    writer.add_topic(topic, definition(topic.type))
    writer.write(topic.name, 1, 1, string("said"))
    writer.close()
    students = folder / "students"
    (students / HOSTILE).mkdir(parents=True)
    (students / HOSTILE / "teleop_node.py").write_text(f"{HOSTILE}(")
    return {
        **{"name": HOSTILE, "file": file, "world": world, "named": named, "bag": bag},
        **{"folder": folder, "students": students},
    }


@pytest.mark.parametrize("command", COMMANDS)
def test_hostile_names(command, inputs, tmp_path):
    program, *words = command.split()
    words = [word.format(**inputs) for word in words]
    environment = {**os.environ, "ROS_LOG_DIR": str(tmp_path), "COLUMNS": "500", "GZ_PARTITION": tmp_path.name}
    done = subprocess.run(
        [BIN / program, *words], capture_output=True, env=environment, cwd=tmp_path, stdin=subprocess.DEVNULL
    )
    said = (done.stdout + done.stderr).decode(errors="replace").replace("\r\n", "\n")
    assert said == printable(said), (command, said)
    assert said
    if command == "ros2 bag play {bag}":
        assert "has no name that ROS allows" in said


def test_every_program_is_asked():
    """No program that a terminal starts is left out above."""
    asked = {tuple(command.split()[2:4]) for command in COMMANDS if command.startswith("ros2 run ")}
    assert {(path.parent.name, path.name) for path in LIBRARY.glob("*/*")} <= asked
    of_the_package = {each.name for each in entry_points(group="console_scripts") if "gz_course." in each.value}
    assert of_the_package <= {command.split()[0] for command in COMMANDS}


def test_what_a_terminal_obeys_is_replaced():
    assert printable("a\x1b[31mb\tc\r\nd\re\x9bf") == "a\ufffd[31mb\tc\r\nd\ufffde\ufffdf"


def test_the_filter_is_a_stream(monkeypatch):
    stream = io.StringIO()
    monkeypatch.setattr(sys, "stdout", stream)
    monkeypatch.setattr(sys, "stderr", stream)
    terminal_text.guard()
    terminal_text.guard()
    print("a\x1bb", end="")
    sys.stderr.writelines(["c\x07", "d"])
    assert (stream.getvalue(), sys.stdout.getvalue()) == ("a\ufffdbc\ufffdd", stream.getvalue())
