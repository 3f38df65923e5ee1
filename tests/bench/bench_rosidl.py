"""Interfaces made at run time: how fast their messages are against their compiled twins, and how soon they can be used.

The same payload goes from a publisher to the callback of a subscription in one process, in turns with the compiled and
the other class, so that both see the same machine.
"""

import array
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from gz_course.grader.run.domain import Domain
from gz_course.tests.bench.row import Row

TURNS = 10
PAYLOADS = {
    "Twist": ("geometry_msgs", 300, 3.0),
    "LaserScan": ("sensor_msgs", 300, 3.0),
    "Image": ("sensor_msgs", 40, 1.5),
}
"""Kind -> (package, messages of one turn, wanted ratio)."""
STARTS = 7
KEPT = 100_000

FIRST_USE = """
import rclpy, sensor_msgs.msg, geometry_msgs.msg, action_msgs.srv, time
for each in (geometry_msgs.msg.TransformStamped, action_msgs.srv.CancelGoal):  # compiled, and needed by tf2_msgs
    type(each).__import_type_support__()
start = time.process_time()
from tf2_msgs.msg import TF2Error, TFMessage
for each in (TFMessage, TF2Error):
    type(each).__import_type_support__()
messages = time.process_time() - start
from tf2_msgs.srv import FrameGraph
from tf2_msgs.action import LookupTransform
for each in (FrameGraph, LookupTransform):
    type(each).__import_type_support__()
print(messages, time.process_time() - start)
"""


def payload(made: Any) -> Any:
    message = made()
    if made.__name__ == "LaserScan":
        message.ranges = message.intensities = array.array("f", [1.5] * 750)
    elif made.__name__ == "Image":
        message.data = array.array("B", bytes(900_000))
    else:
        message.linear.x = 0.5
    return message


class Loop:
    """A publisher and a subscription of one class."""

    def __init__(self, node: Any, made: Any, topic: str) -> None:
        self.message = payload(made)
        self.arrived = 0
        self.publisher = node.create_publisher(made, topic, 10)
        self.subscription = node.create_subscription(made, topic, self._count, 10)

    def _count(self, _: Any) -> None:
        self.arrived += 1

    def times(self, executor: Any, count: int) -> list[float]:
        """Return how long each message took to its callback [s]."""
        taken = []
        for _ in range(count):
            seen, start = self.arrived, time.perf_counter()
            self.publisher.publish(self.message)
            while self.arrived == seen:
                executor.spin_once(timeout_sec=1.0)
            taken.append(time.perf_counter() - start)
        return taken


def memory() -> int:
    """Return the memory of this process [bytes]."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def message_rows(node: Any, executor: Any) -> Iterator[Row]:
    import importlib

    from gz_course.sim.ros.rosidl.interface_classes import classes_of

    for kind, (package, count, wanted) in PAYLOADS.items():
        text = Path(sys.prefix, "share", package, "msg", f"{kind}.msg")
        compiled = getattr(importlib.import_module(f"{package}.msg"), kind)
        loops = [Loop(node, each, f"/{kind}{i}") for i, each in enumerate((compiled, classes_of(text, package)[kind]))]
        for loop in loops:
            while not loop.publisher.get_subscription_count():
                executor.spin_once(timeout_sec=0.05)
            loop.times(executor, 20)
        taken: list[list[float]] = [[], []]
        for _ in range(TURNS):
            for loop, times in zip(loops, taken, strict=True):
                times += loop.times(executor, count)
        reference, measured = (statistics.median(times) * 1e6 for times in taken)
        size = memoryview(getattr(loops[0].message, "data", b"")).nbytes
        name = f"{kind} made at run time, publish to callback" + (f" ({size / 1e6:.1f} MB)" if size else "")
        yield Row(
            name,
            f"{measured:.0f} us",
            f"compiled: {reference:.0f} us",
            f"{measured / reference:.2f}",
            f"at most {wanted}",
        )
        if kind == "Twist":
            before = memory()
            loops[1].times(executor, KEPT)
            grown = (memory() - before) / 1e6
            yield Row(f"memory after {KEPT:,} messages", f"{grown:+.1f} MB", "before", "", "flat")


def rows() -> Iterator[Row]:
    import rclpy
    from rclpy.executors import SingleThreadedExecutor

    with Domain() as domain:
        os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
        context = rclpy.Context()
        rclpy.init(context=context, domain_id=domain.id)
        node = rclpy.create_node("bench", context=context)
        executor = SingleThreadedExecutor(context=context)
        executor.add_node(node)
        yield from message_rows(node, executor)
        executor.shutdown()
        node.destroy_node()
        context.try_shutdown()
    # The modules of the course are compiled once, as in an installation.
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    command = [sys.executable, "-c", FIRST_USE]
    runs = [subprocess.run(command, capture_output=True, text=True, check=True, env=environment) for _ in range(STARTS)]
    messages, every = (statistics.median(float(run.stdout.split()[i]) for run in runs) * 1e3 for i in (0, 1))
    yield Row("first use of the messages of tf2_msgs", f"{messages:.0f} ms of processor time", "", "", "at most 20 ms")
    yield Row("first use of all of tf2_msgs", f"{every:.0f} ms of processor time", "", "", "at most 500 ms")
