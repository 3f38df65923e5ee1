"""What commands of `ros2` and `gz` cost that need no other process, against starting Python at all.

With `REAL_ROS2=PROGRAM`, such as a script that sources an installation and runs its `ros2`, that program is what the
rows of `ros2` are compared with.
"""

import os
import resource
import shlex
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

from gz_course.tests.bench.row import Row

RUNS = 7
COMMANDS = (
    "ros2 --help",
    "ros2 topic --help",
    "ros2 pkg list",
    "ros2 pkg prefix rclpy",
    "ros2 pkg executables ros_gz_bridge",
    "ros2 interface list",
    "ros2 interface show geometry_msgs/msg/Twist",
    "ros2 interface proto sensor_msgs/msg/LaserScan",
    "ros2 launch ros_gz_sim gz_sim.launch.py -s",
    "gz --help",
    "gz msg -l",
    "gz msg -i gz.msgs.Twist",
    "gz sim --help",
)


def cost(command: list[str]) -> tuple[float, float]:
    """Return the medians of wall time and processor time [s] of a command."""
    walls, processors = [], []
    for _ in range(RUNS):
        before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        subprocess.run(command, check=True, capture_output=True)
        walls.append(time.monotonic() - start)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        processors.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return statistics.median(walls), statistics.median(processors)


def rows() -> Iterator[Row]:
    real = shlex.split(os.environ.get("REAL_ROS2", ""))
    bare = cost([sys.executable, "-c", "pass"])
    for line in COMMANDS:
        program, *words = line.split()
        wall, processor = cost([str(Path(sys.executable).with_name(program)), *words])
        ours = f"{wall:.2f} s, processor {processor:.2f} s"
        if real and program == "ros2":
            there = cost([*real, *words])[0]
            yield Row(line, ours, f"the real one: {there:.2f} s", f"{wall / there:.2f}", "at most 0.6")
        else:
            yield Row(line, ours, f"python -c pass: {bare[0]:.2f} s", f"{wall / bare[0]:.1f}", "")
