"""Launches that start nothing and tell the grader that they did: what is claimed is not there, and earns nothing."""

from pathlib import Path

import pytest

from gz_course.grader.exercise import find_exercise
from gz_course.grader.grade import grade
from gz_course.grader.record.reading import Recording

ROOT = Path(__file__).parents[2]
# A simulator, a bridge and a stopwatch, told over the grader's own connection, each in a process of its own.
TELL = """
import json, os, signal, sys, time
from course_agent.channel import channel as connected
channel = connected()._socket
def tell(**message):
    channel.send(json.dumps(message).encode())
def report(*endpoints):
    counts = {"clock": None, "idle": True, "taken": {}, "published": {}, "delivered": {}, "holding": True, "held": 0}
    tell(**counts, released=0, flushes=0, endpoints=[
        {"node": node, "kind": kind, "topic": topic, "type": type_, "reliability": "RELIABLE", "durability": "VOLATILE",
         "matched": 1} for node, kind, topic, type_ in endpoints
    ])
what, world, paused = sys.argv[1:4]
gz = os.path.join(os.path.dirname(sys.executable), "gz")
command = [sys.executable, gz, "sim", "-s", world] if what == "world" else [sys.executable, what]
tell(hello={"pid": os.getpid(), "group": os.getpgid(0), "command": command})
if what == "world":
    tell(loading=True)
    tell(world={"given": world, "path": world, "built_in": world, "description": "", "error": ""})
    channel.recv(1 << 20)
    tell(run={"paused": paused == "true", "iterations": 0}, waiting=True)
elif what == "bridge":
    clock = {"source": "bridge.yaml:1", "ros_topic": "/clock", "ros_type": "rosgraph_msgs/msg/Clock"}
    clock |= {"gz_topic": "/clock", "gz_type": "gz.msgs.Clock", "direction": "GZ_TO_ROS"}
    tell(bridge={"entries": [clock], "frame_id": None, "node": "/ros_gz_bridge"})
else:
    report(("/stopwatch", "publisher", "/stopwatch", "std_msgs/msg/Float64"),
           ("/stopwatch", "subscription", "/clock", "rosgraph_msgs/msg/Clock"))
signal.signal(signal.SIGINT, lambda *_: (tell(stopped=True), os._exit(0)))
time.sleep(1000)
"""
LAUNCH = """
import sys
from pathlib import Path
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import LaunchConfiguration
TELL = str(Path(__file__).parent / "tell.py")
def generate_launch_description():
    given = [LaunchConfiguration("world"), LaunchConfiguration("paused")]
    return LaunchDescription([
        DeclareLaunchArgument("world", default_value="lidar_room.sdf"),
        DeclareLaunchArgument("paused", default_value="false"),
        *(ExecuteProcess(cmd=[sys.executable, TELL, what, *given]) for what in ("world", "bridge", "stopwatch.py")),
    ])
"""


@pytest.mark.proof
@pytest.mark.parametrize("trial", ["without_arguments", "paused"])
def test_a_launch_that_only_tells_of_programs_has_none(trial, tmp_path):
    (tmp_path / "bringup.launch.py").write_text(LAUNCH)
    (tmp_path / "tell.py").write_text(TELL)
    exercise = find_exercise("02_launch", ROOT)
    trials = tuple(each for each in exercise.trials if each.name == trial)
    report = grade(exercise, tmp_path, tmp_path / "out", trials=trials)
    assert report.score.points == 0, report.score.checks
    (recording,) = (tmp_path / "out").glob("*.rrd")
    facts = Recording(recording).facts()
    assert facts["launch"]["refused"] == ["a bridge", "a simulator"]
    assert [e for e in facts["endpoints"] if e["node"] == "/stopwatch"] == []
