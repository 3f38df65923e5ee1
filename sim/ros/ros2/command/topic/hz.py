"""Print the average receiving rate of a topic."""

from __future__ import annotations

import argparse
import time
from collections import deque
from collections.abc import Callable
from typing import Any

from gz_course.sim.ros.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros.ros2.measurement import add_window, awaited_topic, measure, spread
from gz_course.sim.ros.ros2.topic import message_filter

WINDOW = 10000
_NANOSECONDS = 1e-9


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_graph_options(parser)
    parser.add_argument("topic_name", help="Name of the ROS topic to listen to (e.g. '/chatter')")
    add_window(parser, WINDOW)
    parser.add_argument("--filter", metavar="EXPR", help="Only measure messages matching the Python expression")
    parser.add_argument("--wall-time", action="store_true", help="Calculates rate using wall time")


def main(arguments: argparse.Namespace) -> None:
    passes = message_filter(arguments.filter)
    with Graph(arguments) as graph:
        name, kind = awaited_topic(graph, arguments.topic_name)
        clock = time.time_ns if arguments.wall_time else lambda: graph.node.get_clock().now().nanoseconds
        rate = Rate(clock, arguments.window)

        def arrived(message: Any) -> None:
            if passes is None or passes(message):
                rate.tick()

        measure(graph, name, kind, arrived, rate.report, raw=passes is None)


class Rate:
    """The intervals between the last `window` messages; the clock returns [ns]."""

    def __init__(self, clock: Callable[[], int], window: int) -> None:
        self._clock = clock
        self._intervals: deque[float] = deque(maxlen=window)
        self._last: int | None = None
        self._news = False

    def tick(self) -> None:
        """Record a message; ignore it before the first `/clock` (zero), and restart if the clock jumps back."""
        now = self._clock()
        if now == 0:
            self._intervals.clear()
            self._last = None
            return
        if self._last is not None and now == self._last:
            return
        if self._last is not None and now > self._last:
            self._intervals.append((now - self._last) * _NANOSECONDS)
            self._news = True
        else:
            self._intervals.clear()
        self._last = now

    def report(self) -> str:
        """Return rate, minimum, maximum and standard deviation of the intervals; empty without new messages."""
        if not self._news:
            return ""
        self._news = False
        mean = sum(self._intervals) / len(self._intervals)
        return f"average rate: {1.0 / mean:.3f}\n{spread(self._intervals)}"
