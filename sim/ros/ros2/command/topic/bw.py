"""Display bandwidth used by topic."""

from __future__ import annotations

import argparse
import time
from collections import deque
from collections.abc import Callable

from gz_course.sim.ros.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros.ros2.measurement import add_window, awaited_topic, measure

WINDOW = 100
_UNITS = ((1e3, 1.0, "{:.0f} B"), (1e6, 1e3, "{:.2f} KB"), (float("inf"), 1e6, "{:.2f} MB"))
_NANOSECONDS = 1e-9


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_graph_options(parser)
    parser.add_argument("topic_name", help="Topic name to monitor for bandwidth utilization")
    add_window(parser, WINDOW)


def main(arguments: argparse.Namespace) -> None:
    with Graph(arguments) as graph:
        name, kind = awaited_topic(graph, arguments.topic_name)
        in_sim_time = arguments.use_sim_time
        clock = (lambda: graph.node.get_clock().now().nanoseconds) if in_sim_time else time.monotonic_ns
        bandwidth = Bandwidth(clock, arguments.window)
        print(f"Subscribed to [{name}]")
        measure(graph, name, kind, bandwidth.arrived, bandwidth.report, raw=True)


class Bandwidth:
    """The sizes and arrival times of the last `window` messages; the clock returns [ns]."""

    def __init__(self, clock: Callable[[], int], window: int) -> None:
        self._clock = clock
        self._messages: deque[tuple[int, int]] = deque(maxlen=window)

    def arrived(self, message: bytes) -> None:
        """Record the size of a serialized message."""
        self._messages.append((self._clock(), len(message)))

    def report(self) -> str:
        """Return the rate over the window and the sizes; empty with fewer than two messages."""
        if len(self._messages) < 2:
            return ""
        passed = (self._clock() - self._messages[0][0]) * _NANOSECONDS
        if passed <= 0.0:  # simulated time was reset
            self._messages.clear()
            return ""
        sizes = [size for _, size in self._messages]
        rate = sum(sizes) / passed
        # All four use the unit of the rate, so that they can be compared.
        scale, form = next((scale, form) for limit, scale, form in _UNITS if rate < limit)
        rate_text, mean, least, most = (
            form.format(value / scale) for value in (rate, sum(sizes) / len(sizes), min(sizes), max(sizes))
        )
        return f"{rate_text}/s from {len(sizes)} messages\n\tMessage size mean: {mean} min: {least} max: {most}"
