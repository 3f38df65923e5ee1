"""Measures a topic for `ros2 topic hz`, `bw` and `delay`."""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable, Collection
from typing import Any

from rclpy.qos import QoSPresetProfiles

from gz_course.sim.ros.ros2.graph import Graph
from gz_course.sim.ros.ros2.option_values import positive_number
from gz_course.sim.ros.ros2.topic import full_name, nearest_topic, not_published, only_type, warn

REPORT_EVERY = 1.0  # [s]


def add_window(parser: argparse.ArgumentParser, default: int) -> None:
    """Add the option for the number of messages in a report."""
    parser.add_argument(
        "-w",
        "--window",
        type=positive_number,
        default=default,
        metavar="N",
        help=f"Window size, in # of messages, for calculating (default: {default})",
    )


def awaited_topic(graph: Graph, topic: str) -> tuple[str, Any]:
    """Wait for a topic and report the wait; return its full name and message class.

    Raises CommandError for an invalid name, an unknown type or several types.
    """
    name = full_name(graph, topic)
    types = graph.wait_for_topic(name)
    if not types:
        not_published(name)
        if hint := nearest_topic(graph, name):
            warn(f"still waiting for {name}{hint}")
    while not types:
        types = graph.wait_for_topic(name)
    return name, only_type(name, types, "measure")


def measure(
    graph: Graph,
    name: str,
    kind: Any,
    arrived: Callable[[Any], None],
    report: Callable[[], str],
    *,
    raw: bool = False,
) -> None:
    """Call `arrived` with each message (`raw`: serialized), and print `report` every second, without end.

    An empty report is not printed.
    """
    qos = QoSPresetProfiles.get_from_short_key("sensor_data")
    graph.node.create_subscription(kind, name, arrived, qos, raw=raw)
    report_at = time.monotonic() + REPORT_EVERY
    while True:
        graph.spin_once(min(0.1, max(0.0, report_at - time.monotonic())))
        if time.monotonic() >= report_at:
            report_at += REPORT_EVERY
            if text := report():
                print(text)


def spread(values: Collection[float]) -> str:
    """Return the second line of a report: the statistics of at least one time [s]."""
    mean = sum(values) / len(values)
    deviation = math.sqrt(sum((value - mean) ** 2 for value in values) / len(values))
    return f"\tmin: {min(values):.3f}s max: {max(values):.3f}s std dev: {deviation:.5f}s window: {len(values)}"
