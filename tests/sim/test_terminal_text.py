"""No command of ours writes control codes of others to a terminal, whatever names it is given."""

import io
import os
import subprocess
import sys
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
]


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
    return {"name": HOSTILE, "file": file, "world": world, "named": named, "bag": bag}


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
