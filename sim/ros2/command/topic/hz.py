"""Print the average receiving rate of a topic."""

from __future__ import annotations

import argparse
import math
import time
from collections import deque
from collections.abc import Callable
from typing import Any

from rclpy.qos import QoSPresetProfiles

from ros2.graph import Graph, add_graph_options
from ros2.topic import full_name, message_filter, nearest_topic, not_published, only_type, warn

WINDOW = 10000
_REPORT_EVERY = 1.0  # s
_NANOSECONDS = 1e-9


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The topic, the window and the clock."""
    add_graph_options(parser)
    parser.add_argument("topic_name", help="Name of the ROS topic to listen to (e.g. '/chatter')")
    parser.add_argument(
        "-w",
        "--window",
        type=whole_number,
        default=WINDOW,
        metavar="N",
        help=f"Window size, in # of messages, for calculating rate (default: {WINDOW})",
    )
    parser.add_argument("--filter", metavar="EXPR", help="Only measure messages matching the Python expression")
    parser.add_argument("--wall-time", action="store_true", help="Calculates rate using wall time")


def whole_number(text: str) -> int:
    """A number from 1 on; ValueError otherwise."""
    value = int(text)
    if value < 1:
        raise ValueError
    return value


def main(arguments: argparse.Namespace) -> None:
    """Report once a second while messages arrive, until interrupted."""
    with Graph(arguments) as graph:
        name = full_name(graph, arguments.topic_name)
        types = graph.wait_for_topic(name)
        if not types:
            not_published(name)
            if hint := nearest_topic(graph, name):
                warn(f"still waiting for {name}{hint}")
        while not types:
            types = graph.wait_for_topic(name)
        passes = message_filter(arguments.filter)
        clock = time.time_ns if arguments.wall_time else lambda: graph.node.get_clock().now().nanoseconds
        rate = Rate(clock, arguments.window)

        def arrived(message: Any) -> None:
            if passes is None or passes(message):
                rate.tick()

        kind = only_type(name, types, "measure")
        qos = QoSPresetProfiles.get_from_short_key("sensor_data")
        graph.node.create_subscription(kind, name, arrived, qos, raw=passes is None)
        report_at = time.monotonic() + _REPORT_EVERY
        while True:
            graph.spin_once(min(0.1, max(0.0, report_at - time.monotonic())))
            if time.monotonic() >= report_at:
                report_at += _REPORT_EVERY
                if text := rate.report():
                    print(text)


class Rate:
    """The intervals between the last `window` messages, by a clock in nanoseconds."""

    def __init__(self, clock: Callable[[], int], window: int) -> None:
        self._clock = clock
        self._intervals: deque[float] = deque(maxlen=window)
        self._last: int | None = None
        self._news = False

    def tick(self) -> None:
        """A message has arrived. A clock that stands still or jumps back begins a new measurement."""
        now = self._clock()
        if self._last is not None and now == self._last:
            return
        if self._last is not None and now > self._last:
            self._intervals.append((now - self._last) * _NANOSECONDS)
            self._news = True
        else:
            self._intervals.clear()
        self._last = now

    def report(self) -> str:
        """The rate, smallest, largest and spread of the intervals; empty if nothing new has arrived."""
        if not self._news:
            return ""
        self._news = False
        count = len(self._intervals)
        mean = sum(self._intervals) / count
        spread = math.sqrt(sum((interval - mean) ** 2 for interval in self._intervals) / count)
        return (
            f"average rate: {1.0 / mean:.3f}\n"
            f"\tmin: {min(self._intervals):.3f}s max: {max(self._intervals):.3f}s "
            f"std dev: {spread:.5f}s window: {count}"
        )
