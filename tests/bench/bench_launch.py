"""What `ros2 launch` costs: one trivial process, in Python and XML, against Python's start; the end of a simulation."""

import os
import signal
import statistics
import subprocess
import sys
import tempfile
import time
import uuid
from collections.abc import Iterator
from pathlib import Path

from gz_course.tests.bench.row import Row

ROS2 = Path(sys.executable).with_name("ros2")
RUNS = 11
TRIVIAL = """\
from launch import LaunchDescription
from launch.actions import ExecuteProcess
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([ExecuteProcess(cmd=["true"])])
"""
SAME_IN_XML = '<launch><executable cmd="true"/></launch>\n'
MANY = """\
from launch import LaunchDescription
from launch.actions import ExecuteProcess, RegisterEventHandler, Shutdown
from launch.event_handlers import OnProcessIO


def generate_launch_description():
    up = []

    def count(event):
        up.append(event)
        return Shutdown() if len(up) == 50 else None

    sleepers = [ExecuteProcess(cmd=["sh", "-c", "echo up; exec sleep 1000"]) for _ in range(50)]
    return LaunchDescription([RegisterEventHandler(OnProcessIO(on_stdout=count)), *sleepers])
"""
TALKER = """\
from launch import LaunchDescription
from launch.actions import ExecuteProcess


def generate_launch_description():
    return LaunchDescription([ExecuteProcess(cmd=["seq", "300000"], output="screen")])
"""
SIMULATION = """\
from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    gazebo = IncludeLaunchDescription(
        [FindPackageShare("ros_gz_sim"), "/launch/gz_sim.launch.py"],
        launch_arguments={"gz_args": "-r -s lidar_room.sdf"},
    )
    bridge = Node(
        package="ros_gz_bridge",
        executable="parameter_bridge",
        arguments=["/model/robot/cmd_vel@geometry_msgs/msg/Twist]gz.msgs.Twist"],
        output="screen",
    )
    return LaunchDescription([gazebo, bridge])
"""


def whole_run(command: list) -> float:
    """Run a command; return how long it took [s]."""
    start = time.monotonic()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
    return time.monotonic() - start


def from_ctrl_c_to_the_end(command: list) -> float:
    """Start a launch, interrupt it when its bridge is ready; return how long its end took [s]."""
    with subprocess.Popen(command, stdout=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True) as process:
        for line in process.stdout:
            if "ready: 1 bridge" in line:
                break
        start = time.monotonic()
        process.send_signal(signal.SIGINT)
        process.stdout.read()
        assert process.wait() == 0
        return time.monotonic() - start


def xml_against_python(python: list, file: Path) -> Row:
    """Compare the same launch file in both, run by turns."""
    file.write_text(SAME_IN_XML)
    pairs = [(whole_run([ROS2, "launch", str(file)]), whole_run(python)) for _ in range(RUNS)]
    xml, reference = (statistics.median(times) for times in zip(*pairs, strict=True))
    return Row(
        "ros2 launch of an XML file",
        f"{xml * 1e3:.0f} ms",
        f"the same in Python: {reference * 1e3:.0f} ms",
        f"{xml / reference:.2f}",
        "at most 1.1",
    )


def rows() -> Iterator[Row]:
    os.environ |= {"GZ_PARTITION": f"bench-{uuid.uuid4()}", "GZ_IP": "127.0.0.1"}
    with tempfile.TemporaryDirectory() as folder:
        os.environ["ROS_LOG_DIR"] = folder
        files = {"trivial": TRIVIAL, "many": MANY, "talker": TALKER, "simulation": SIMULATION}
        commands = {}
        for name, text in files.items():
            path = Path(folder) / f"{name}.launch.py"
            path.write_text(text)
            commands[name] = [ROS2, "launch", str(path)]
        yield xml_against_python(commands["trivial"], Path(folder) / "trivial.launch.xml")
        python = statistics.median(whole_run([sys.executable, "-c", "pass"]) for _ in range(RUNS))
        reference = f"python -c pass: {python * 1e3:.0f} ms"
        for name, measure, key, runs, wanted in (
            ("ros2 launch of one trivial process, whole run", whole_run, "trivial", RUNS, "at most 250 ms"),
            ("ros2 launch of 50 processes, started and ended", whole_run, "many", 5, "no orphan, at most 2 s"),
            ("ros2 launch of a process that prints 300000 lines", whole_run, "talker", 3, "at most 3 s"),
            ("simulator and bridge, Ctrl-C to the end", from_ctrl_c_to_the_end, "simulation", 5, "at most 2 s"),
        ):
            times = [measure(commands[key]) for _ in range(runs)]
            median = statistics.median(times)
            yield Row(
                name,
                f"{median * 1e3:.0f} ms (slowest {max(times) * 1e3:.0f})",
                reference,
                f"{median / python:.1f}",
                wanted,
            )
