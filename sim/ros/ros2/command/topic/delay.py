"""Display delay of topic from timestamp in header."""

from __future__ import annotations

import argparse
from collections import deque
from collections.abc import Callable
from typing import Any

from rclpy.time import Time

from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros.ros2.measurement import add_window, awaited_topic, measure, spread

WINDOW = 10000
_NANOSECONDS = 1e-9


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_graph_options(parser)
    parser.add_argument("topic_name", help="Topic name to calculate the delay for")
    add_window(parser, WINDOW)


def main(arguments: argparse.Namespace) -> None:
    """Report every second until interrupted. Stamps in simulated time need --use-sim-time."""
    with Graph(arguments) as graph:
        name, kind = awaited_topic(graph, arguments.topic_name)
        if "header" not in kind.get_fields_and_field_types():
            raise CommandError("msg does not have header")
        delay = Delay(lambda: graph.node.get_clock().now().nanoseconds, arguments.window)
        measure(graph, name, kind, delay.arrived, delay.report)


class Delay:
    """The ages of the last `window` messages at their arrival; the clock returns [ns]."""

    def __init__(self, clock: Callable[[], int], window: int) -> None:
        self._clock = clock
        self._delays: deque[float] = deque(maxlen=window)
        self._news = False
        self._last = 0

    def arrived(self, message: Any) -> None:
        """Record a message with a header; restart if the clock jumps back, and ignore messages while it is 0."""
        now = self._clock()
        if now < self._last:
            self._delays.clear()
        self._last = now
        if now:
            self._delays.append((now - Time.from_msg(message.header.stamp).nanoseconds) * _NANOSECONDS)
            self._news = True

    def report(self) -> str:
        """Return mean, minimum, maximum and standard deviation of the delays; empty before the first message."""
        if not self._delays:
            return ""
        if not self._news:
            return "no new messages"
        self._news = False
        return f"average delay: {sum(self._delays) / len(self._delays):.3f}\n{spread(self._delays)}"
