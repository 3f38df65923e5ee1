"""`course diagnose` as a user runs it: among real processes, from a healthy system to one whose parts are killed."""

import json
import os
import signal
import sys
import threading
import time

import psutil
import pytest

BRIDGE = "parameter_bridge --ros-args -p config_file:=exercises/03_teleop/bridge.yaml"
LISTENER = """
import rclpy
from sensor_msgs.msg import LaserScan
rclpy.init()
node = rclpy.create_node("listener")
node.create_subscription(LaserScan, "/lidar/scan", print, 10)
print("listening", flush=True)
rclpy.spin(node)
"""
OTHER_PARTITION = """
import signal
from gz.msgs.world_stats_pb2 import WorldStatistics
from gz.transport import Node
node = Node()
node.advertise("/world/far/stats", WorldStatistics)
print("ready", flush=True)
signal.pause()
"""
DEADLINE = 120.0


def wait_for(program, words):
    pause, end = threading.Event(), time.monotonic() + DEADLINE
    while words not in program.output:
        assert program.exit_code is None and time.monotonic() < end, f"no {words!r} in {program.output}"
        pause.wait(0.02)


def ready_bridge(room):
    bridge = room.start(BRIDGE)
    wait_for(bridge, "ready")
    return bridge


def report(course, *arguments, code):
    done = course("diagnose", "--json", *arguments)
    assert done.returncode == code, done.stdout + done.stderr
    return json.loads(done.stdout)


def sentences(report, kind):
    return [finding["sentence"] for finding in report["findings"] if finding["kind"] == kind]


@pytest.mark.proof
def test_from_a_healthy_system_to_one_whose_parts_are_gone(room, course, tmp_path):
    listener = tmp_path / "listener.py"
    listener.write_text(LISTENER)
    simulator = room.start("gz sim lidar_room.sdf -r -s")
    bridge = ready_bridge(room)
    wait_for(room.start(f"{sys.executable} {listener}"), "ranges")

    done = course("diagnose")
    assert done.returncode == 0, done.stdout + done.stderr
    words = " ".join(done.stdout.split())
    assert "2 nodes, bridges: /ros_gz_bridge (4)." in words and "worlds: lidar_room." in words
    assert "ERROR" not in words and "WARNING" not in words
    assert words.endswith("Nothing is wrong; see the notes above.")
    assert done.stderr == ""

    os.killpg(bridge.pid, signal.SIGKILL)
    bridge.stop()
    killed = report(course, "--seconds", "0.5", code=1)
    assert sentences(killed, "not_bridged") == [
        "/listener listens on /lidar/scan in ROS and Gazebo publishes it, but no ros_gz_bridge runs."
    ]
    first = killed["findings"][0]
    assert (
        first["fix"]
        == "Start it: ros2 run ros_gz_bridge parameter_bridge '/lidar/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan'"
    )
    assert first["evidence"] == [
        "ROS: /lidar/scan (sensor_msgs/msg/LaserScan)",
        "Gazebo: /lidar/scan (gz.msgs.LaserScan)",
    ]
    assert killed["gz"]["worlds"] == ["lidar_room"] and killed["ros"]["nodes"] == ["/listener"]

    simulator.stop()
    ready_bridge(room)
    other = tmp_path / "other.py"
    other.write_text(OTHER_PARTITION)
    wait_for(room.start(f"env GZ_PARTITION=00_{room.partition} {sys.executable} {other}"), "ready")
    alone = report(course, "--seconds", "0.5", code=1)
    assert sentences(alone, "no_world") == [
        f"The bridge /ros_gz_bridge runs, but no simulator runs in the Gazebo partition '{room.partition}'."
    ]
    assert f"partition 00_{room.partition} has the world far" in alone["findings"][0]["evidence"]
    assert [finding["kind"] for finding in alone["findings"]] == ["no_world"], "it explains everything else"
    assert len(alone["ros"]["bridges"]["/ros_gz_bridge"]) == 4


@pytest.mark.proof
def test_a_process_stopped_in_its_terminal(room, course, tmp_path):
    listener, simulator = tmp_path / "listener.py", tmp_path / "simulator.py"
    listener.write_text(LISTENER)
    simulator.write_text(OTHER_PARTITION)
    programs = [room.start(f"{sys.executable} {file}") for file in (listener, simulator)]
    wait_for(programs[0], "listening")
    wait_for(programs[1], "ready")
    elsewhere = room.start(f"env GZ_PARTITION=00_{room.partition} {sys.executable} {simulator}")
    wait_for(elsewhere, "ready")
    for program in (*programs, elsewhere):
        os.kill(program.pid, signal.SIGSTOP)
    try:
        found = report(course, "--seconds", "0.1", code=1)
    finally:
        for program in (*programs, elsewhere):
            os.kill(program.pid, signal.SIGCONT)
    assert sorted(sentences(found, "stopped_process")) == sorted(
        f"The process {program.pid} is stopped (Ctrl-Z), so it neither sends nor hears anything."
        for program in programs
    )
    assert found["findings"][0]["kind"] == "stopped_process"


def test_an_interrupt_ends_it_at_once(room):
    script = "from gz_course.grader.course import main; main()"
    command = room.start(f"{sys.executable} -c '{script}' diagnose --seconds 60")
    ports = range(7400 + 250 * room.domain, 7650 + 250 * room.domain)
    process, pause, end = psutil.Process(command.pid), threading.Event(), time.monotonic() + DEADLINE
    while not any(each.laddr.port in ports for each in process.net_connections("udp")):
        assert command.exit_code is None and time.monotonic() < end, command.output
        pause.wait(0.02)
    process.send_signal(signal.SIGINT)
    while command.exit_code is None:
        assert time.monotonic() < end, command.output
        pause.wait(0.02)
    assert command.exit_code == 130
    assert "Traceback" not in command.output


@pytest.mark.parametrize("seconds", ["0", "-1", "61", "nan", "soon"])
def test_a_time_that_is_none(course, seconds):
    done = course("diagnose", "--seconds", seconds)
    assert done.returncode == 2
    assert "--seconds" in done.stderr and "Traceback" not in done.stderr
